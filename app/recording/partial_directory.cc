#include "app/recording/partial_directory.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <string>
#include <system_error>

#include "app/core/check.h"
#include "app/core/error.h"
#include "app/recording/checked_file.h"
#include "app/recording/manifest.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

constexpr char kWritable[] = "a folder that can be written";

fs::path WithSuffix(fs::path path, const char* suffix) {
  path += suffix;
  return path;
}

// Links are resolved, so that two names of one place are one place and a link stays a link.
fs::path Resolve(const fs::path& directory) {
  std::error_code error;
  fs::path path = fs::absolute(directory, error);
  if (!error) path = fs::weakly_canonical(path, error);
  if (error) {
    throw InputError("", "", "the name of a folder",
                     '"' + directory.string() + "\" (" + error.message() + ')');
  }
  if (!path.has_filename()) path = path.parent_path();
  if (path == path.root_path()) {
    throw InputError("", "", "the name of a folder", '"' + directory.string() + '"');
  }
  return path;
}

// Refuses a DIR whose replacement would destroy anything but a finished run.
void RequireReplaceable(const fs::path& directory) {
  constexpr char kExpected[] = "a new or empty folder, or a finished run";
  std::error_code error;
  const fs::file_status status = fs::symlink_status(directory, error);
  if (status.type() == fs::file_type::not_found) return;
  if (error) throw InputError(directory.string(), "", kExpected, error.message());
  if (!fs::is_directory(status)) {
    throw InputError(directory.string(), "", kExpected, "something that is not a folder");
  }
  const bool empty = fs::is_empty(directory, error);
  if (error) throw InputError(directory.string(), "", kExpected, error.message());
  if (empty) return;
  if (!IsFinishedRun(directory)) {
    throw InputError(directory.string(), "", kExpected, "a folder that holds other files");
  }
  if (const auto extra = FindExtraFile(directory)) {
    throw InputError(directory.string(), "", kExpected,
                     "a run with a file that is not part of it, \"" + *extra + '"');
  }
}

bool IsOurs(const fs::path& directory) {
  std::error_code error;
  return fs::is_empty(directory, error) || fs::exists(directory / kUnfinishedMark, error) ||
         IsFinishedRun(directory);
}

// Removes a folder that IsOurs; what makes it ours goes last, so that a removal cut short can be
// completed later. Does nothing for one that is not there.
void RemoveOurs(const fs::path& directory) {
  std::error_code error;
  if (!fs::is_directory(fs::symlink_status(directory, error))) return;
  for (const auto& entry : fs::directory_iterator(directory, error)) {
    const std::string name = entry.path().filename().string();
    if (name == kUnfinishedMark || name == "manifest.json") continue;
    fs::remove_all(entry.path(), error);
    if (error) break;
  }
  if (!error) fs::remove(directory / "manifest.json", error);
  if (!error) fs::remove(directory / kUnfinishedMark, error);
  if (!error) fs::remove(directory, error);
  if (error) throw InputError(directory.string(), "", kWritable, error.message());
}

// RemoveOurs where nothing can be done about a failure: the next run tries again.
void TryRemoveOurs(const fs::path& directory) {
  try {
    RemoveOurs(directory);
  } catch (const InputError&) {
  }
}

void Rename(const fs::path& from, const fs::path& to) {
  if (std::rename(from.c_str(), to.c_str()) != 0) ThrowErrno(to, kWritable);
}

void RequireOurs(const fs::path& path) {
  constexpr char kExpected[] = "no such file or folder, for it is needed to write the run";
  std::error_code error;
  const fs::file_status status = fs::symlink_status(path, error);
  if (status.type() == fs::file_type::not_found) return;
  if (error) throw InputError(path.string(), "", kWritable, error.message());
  if (!fs::is_directory(status) || !IsOurs(path)) {
    throw InputError(path.string(), "", kExpected, "one that is not a run");
  }
}

// What a process that was killed left: see Commit and SwapInto for how each state comes about.
void Recover(const fs::path& target, const fs::path& partial, const fs::path& replaced) {
  RequireOurs(replaced);
  RequireOurs(partial);
  std::error_code error;
  if (fs::exists(replaced, error) && !IsFinishedRun(target)) Rename(replaced, target);
  RemoveOurs(replaced);
  RemoveOurs(partial);
}

fs::path ResolveOutsideRuns(const fs::path& directory) {
  fs::path resolved = Resolve(directory);
  RequireOutsideRuns(resolved);
  return resolved;
}

}  // namespace

void RequireOutsideRuns(const fs::path& path) {
  std::error_code error;
  const auto is_being_written = [&](const fs::path& directory) {
    return fs::exists(WithSuffix(directory, ".partial") / kUnfinishedMark, error);
  };
  const auto refuse = [&](const fs::path& run) {
    throw InputError(path.string(), "", "a place outside of run directories",
                     "one in the run " + run.filename().string());
  };
  const fs::path resolved = Resolve(path);
  for (fs::path at = resolved.parent_path(); at != at.root_path(); at = at.parent_path()) {
    const bool partial = fs::exists(at / kUnfinishedMark, error);
    if (partial || is_being_written(at) || IsFinishedRun(at)) refuse(at);
  }
  const std::string suffix = resolved.extension().string();
  if (suffix != ".partial" && suffix != ".replaced" && suffix != ".lock") return;
  const fs::path run = resolved.parent_path() / resolved.stem();
  if (is_being_written(run)) refuse(run);
}

void SwapInto(const fs::path& fresh, const fs::path& target, bool may_exchange) {
  std::error_code error;
  if (!fs::exists(target, error) || fs::is_empty(target, error)) {
    Rename(fresh, target);
    return;
  }
  if (may_exchange &&
      renameat2(AT_FDCWD, fresh.c_str(), AT_FDCWD, target.c_str(), RENAME_EXCHANGE) == 0) {
    return;
  }
  const fs::path replaced = WithSuffix(target, ".replaced");
  Rename(target, replaced);
  try {
    Rename(fresh, target);
  } catch (const InputError&) {
    Rename(replaced, target);
    throw;
  }
}

PartialDirectory::Lock::Lock(const fs::path& file, const fs::path& directory) : file_(file) {
  while (true) {
    descriptor_ = open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
    if (descriptor_ < 0) ThrowErrno(directory, kWritable);
    struct stat locked {};
    struct stat named {};
    const bool held = flock(descriptor_, LOCK_EX | LOCK_NB) == 0;
    const int reason = errno;
    if (held && fstat(descriptor_, &locked) == 0 && locked.st_size == 0) {
      // The one who held it may have removed the file in between; then this lock is on nothing.
      if (stat(file.c_str(), &named) == 0 && locked.st_ino == named.st_ino &&
          locked.st_dev == named.st_dev) {
        return;
      }
      close(descriptor_);
      continue;
    }
    close(descriptor_);
    if (held) throw InputError(file.string(), "", "no such file, for it is the run's lock", "one");
    if (reason == EWOULDBLOCK) {
      throw InputError(directory.string(), "", "a folder that no other run is writing",
                       "one that is being written");
    }
    errno = reason;
    ThrowErrno(file, "a file that can be locked");
  }
}

PartialDirectory::Lock::~Lock() {
  unlink(file_.c_str());
  close(descriptor_);
}

PartialDirectory::Parents::Parents(const fs::path& directory) {
  std::vector<fs::path> missing;
  std::error_code error;
  for (fs::path parent = directory.parent_path(); !fs::exists(parent, error);
       parent = parent.parent_path()) {
    missing.push_back(parent);
  }
  for (; !missing.empty(); missing.pop_back()) {
    if (mkdir(missing.back().c_str(), 0777) == 0) {
      made.push_back(missing.back());
    } else if (errno != EEXIST) {
      const int reason = errno;
      for (; !made.empty(); made.pop_back()) rmdir(made.back().c_str());
      errno = reason;
      ThrowErrno(directory, kWritable);
    }
  }
}

PartialDirectory::Parents::~Parents() {
  for (; !made.empty(); made.pop_back()) rmdir(made.back().c_str());  // fails where it should
}

PartialDirectory::PartialDirectory(const fs::path& directory)
    : target_(ResolveOutsideRuns(directory)),
      partial_(WithSuffix(target_, ".partial")),
      replaced_(WithSuffix(target_, ".replaced")),
      parents_(target_),
      lock_(WithSuffix(target_, ".lock"), directory) {
  Recover(target_, partial_, replaced_);
  RequireReplaceable(target_);
  if (mkdir(partial_.c_str(), 0777) != 0) ThrowErrno(directory, kWritable);
  try {
    WriteFile(partial_ / kUnfinishedMark, "");
  } catch (const InputError&) {
    TryRemoveOurs(partial_);
    throw;
  }
}

PartialDirectory::~PartialDirectory() {
  if (!committed_) TryRemoveOurs(partial_);
}

void PartialDirectory::Commit() {
  PREGRASP_CHECK(!committed_ && IsFinishedRun(partial_), partial_);
  // Whatever came to be at DIR in the meantime must not be destroyed either.
  RequireReplaceable(target_);
  std::error_code error;
  fs::remove(partial_ / kUnfinishedMark, error);  // from here manifest.json says that it is ours
  if (error) throw InputError(partial_.string(), "", kWritable, error.message());
  std::vector<fs::path> written{partial_};
  const RunFiles names = ListRunFiles(partial_);
  for (const std::string& folder : names.folders) written.push_back(partial_ / folder);
  for (const std::string& file : names.files) {
    if (!fs::is_symlink(partial_ / file)) written.push_back(partial_ / file);
  }
  SyncToDisk(written);
  SwapInto(partial_, target_);
  committed_ = true;
  SyncToDisk({target_.parent_path()});
  TryRemoveOurs(partial_);
  TryRemoveOurs(replaced_);
}

}  // namespace pregrasp
