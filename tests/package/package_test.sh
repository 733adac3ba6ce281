#!/usr/bin/env bash
# package_test.sh SOURCE BUILD: dpkg installs the packages on what looks like this machine without the source and the build, where
# pregrasp plans from /usr, from a prefix that was moved, and a program of others builds against the library. As root.
set -euo pipefail
source_folder=$1 build=$2
if ((EUID != 0)); then
  echo "installing needs root"
  exit 77  # skipped
fi
if [[ ${3:-} != inside ]]; then exec unshare --mount "$0" "$1" "$2" inside; fi

dir=$(mktemp -d)
trap 'umount -R "$dir/root" 2>/dev/null || true; umount "$dir"; rmdir "$dir"' EXIT
mount -t tmpfs none "$dir"
mkdir "$dir/root" "$dir/upper" "$dir/work"
cpack --config "$build/CPackConfig.cmake" -B "$dir/packages" >"$dir/cpack.log" 2>&1 || { cat "$dir/cpack.log"; exit 1; }
ls -l "$dir"/packages/*.deb
for package in "$dir"/packages/*.deb; do dpkg-deb --info "$package" | grep -E '^ (Package|Version|Installed-Size|Depends):'; done
dpkg-deb --contents "$dir"/packages/pregrasp_*.deb | awk '{print $6}' >"$dir/contents"
for file in bin/pregrasp lib/pregrasp/libpregrasp_mrpt.so share/man/man1/pregrasp.1 share/doc/pregrasp/copyright \
  share/doc/pregrasp/docs/more_than_one_machine.md share/pregrasp/lua/meta/pregrasp.lua; do
  grep -qx "./usr/$file" "$dir/contents" || { echo "not in the package: $file"; exit 1; }
done

mount -t overlay overlay -o "lowerdir=/,upperdir=$dir/upper,workdir=$dir/work" "$dir/root"
mount --rbind /proc "$dir/root/proc"
mount --rbind /dev "$dir/root/dev"
mkdir -p "$dir/root/clean/packages" "$dir/root$source_folder" "$dir/root$build"
cp "$dir"/packages/*.deb "$dir/root/clean/packages"
cp -r "$source_folder/tests/package/consumer" "$dir/root/clean"
cmake --install "$build" --component program --prefix "$dir/root/clean/installed" >/dev/null
mount -t tmpfs none "$dir/root$source_folder"
if [[ -e $dir/root$build/pregrasp ]]; then mount -t tmpfs none "$dir/root$build"; fi
chroot "$dir/root" /bin/bash -euo pipefail -x <<'END'
cd /clean
dpkg -i packages/*.deb
pregrasp info | grep -x 'data *\/usr\/share\/pregrasp'
pregrasp run /usr/share/pregrasp/scenes/ruler.lua --out ruler --pictures key
grep '"status"' ruler/summary.json | grep ok
ls ruler/frames | grep -c png
gzip -t <ruler/run.rawlog

mv installed moved
moved/bin/pregrasp info | grep -x 'data *\/clean\/moved\/share\/pregrasp'
printf 'local s = require "pregrasp".open "scenes/ruler.lua"\ns:record{ dir = "out/log" }\ns:graph{}\ns:save()\n' >log.lua
moved/bin/pregrasp script log.lua
[[ -s out/log/run.rawlog ]]

cmake -S consumer -B built -G Ninja -DCMAKE_BUILD_TYPE=Release >/dev/null
cmake --build built
PREGRASP_DATA=/usr/share/pregrasp built/consumer | grep '^ruler: 2 bodies, a hand of '
END
