#!/usr/bin/env bash
# build.sh PRESET [--with PACKAGES_FILE].. [--configure-only | --target TARGET] [CMAKE OPTION]..: installs the Debian packages that are missing, configures and builds.
# Quick when nothing changed. Used by run.sh, test.sh and tests/bench/run.sh.
set -euo pipefail
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")"

preset=$1
shift
lists=(packages.txt)
options=()
configure_only=false
target=all
while (($#)); do
  case $1 in
    --with) lists+=("$2"); shift 2 ;;
    --configure-only) configure_only=true; shift ;;
    --target) target=$2; shift 2 ;;
    *) options+=("$1"); shift ;;
  esac
done

installed() { dpkg-query -W -f='${db:Status-Abbrev}' "$1" 2>/dev/null | grep -q '^ii'; }
no_osmesa() { ! apt-cache show libosmesa6-dev >/dev/null 2>&1; }  # Debian 14: libegl-dev takes its place

missing=()
for package in $(cat "${lists[@]}"); do
  installed "$package" || missing+=("$package")
done
if [[ ${missing[*]} == libosmesa6-dev ]] && no_osmesa; then missing=(); fi
if ((${#missing[@]})); then
  apt=(env DEBIAN_FRONTEND=noninteractive apt-get)
  if ((EUID != 0)); then
    if ! sudo -n true 2>/dev/null; then
      echo "pregrasp needs Debian packages that are missing here. Install them as root, then run this again:" >&2
      echo "  apt-get install --no-install-recommends ${missing[*]}" >&2
      exit 2
    fi
    apt=(sudo "${apt[@]}")
  fi
  echo "installing ${#missing[@]} packages: ${missing[*]}" >&2
  log=$(mktemp)
  install_missing() {
    "${apt[@]}" update || return
    for i in "${!missing[@]}"; do
      if [[ ${missing[i]} == libosmesa6-dev ]] && no_osmesa; then unset "missing[i]"; fi
    done
    "${apt[@]}" install -y --no-install-recommends "${missing[@]}"
  }
  if ! install_missing >"$log" 2>&1; then
    tail -20 "$log" >&2
    echo "installing packages failed; the whole log is $log" >&2
    exit 1
  fi
  rm -f "$log"
fi

build=build/$preset
mkdir -p "$build"
exec 9>"$build/.lock"
flock 9  # two scripts at once must not build into one folder
if ! cmake --preset "$preset" "${options[@]}" >"$build/configure.log" 2>&1; then
  cat "$build/configure.log" >&2
  exit 1
fi
if $configure_only; then exit; fi
if [[ -t 2 ]]; then
  cmake --build --preset "$preset" --target "$target" >&2
elif ! cmake --build --preset "$preset" --target "$target" >"$build/build.log" 2>&1; then
  grep -A20 -m1 'FAILED' "$build/build.log" >&2 || tail -40 "$build/build.log" >&2
  exit 1
fi
