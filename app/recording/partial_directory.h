#pragma once

#include <filesystem>
#include <vector>

namespace pregrasp {

/// Puts `fresh`, a folder, in the place of `target` and removes what was there: in one step of the
/// file system where it can exchange two folders, else by moving the old one aside to
/// TARGET.replaced first. What was at `target` is at `fresh` or at TARGET.replaced afterwards.
/// @param may_exchange  false for the second way, in tests. @throws InputError.
void SwapInto(const std::filesystem::path& fresh, const std::filesystem::path& target,
              bool may_exchange = true);

/// A file or folder that may be made there: not in a run directory, finished or being written, and
/// not one of the files beside it that say that it is being written. @throws InputError.
void RequireOutsideRuns(const std::filesystem::path& path);

/// The right to write a run directory DIR, and the folder DIR.partial in which it is written:
/// - DIR.lock is locked (flock) for as long as this object lives, so that one process at a time
///   writes DIR; the kernel gives it back when a process dies. It is removed at the end.
/// - What a killed process left is cleared away first: DIR.partial is removed, and a DIR that was
///   moved aside is put back if no new one came.
/// - Commit replaces DIR, which is thus absent, the old run or the new one at every moment.
/// Only what is recognised as ours is ever removed: a finished run, and a DIR.partial that is empty
/// or marked as ours.
class PartialDirectory {
 public:
  /// @throws InputError if DIR holds anything but a finished run, lies in another, another process
  /// is writing it, or the system refuses.
  explicit PartialDirectory(const std::filesystem::path& directory);
  /// Without Commit, removes all that was made here.
  ~PartialDirectory();
  PartialDirectory(const PartialDirectory&) = delete;
  PartialDirectory& operator=(const PartialDirectory&) = delete;

  /// DIR.partial.
  const std::filesystem::path& path() const { return partial_; }
  /// DIR, absolute and with links resolved.
  const std::filesystem::path& target() const { return target_; }

  /// Waits until all is on the disk, then puts it at DIR. manifest.json must be written: it is what
  /// marks a finished run.
  void Commit();

 private:
  // A lock on a file that exists while it is held.
  class Lock {
   public:
    Lock(const std::filesystem::path& file, const std::filesystem::path& directory);
    ~Lock();
    Lock(const Lock&) = delete;
    Lock& operator=(const Lock&) = delete;

   private:
    std::filesystem::path file_;
    int descriptor_ = -1;
  };

  // Folders above DIR that did not exist, removed again if nothing came to be in them.
  struct Parents {
    explicit Parents(const std::filesystem::path& directory);
    ~Parents();
    std::vector<std::filesystem::path> made;  // outermost first
  };

  std::filesystem::path target_, partial_, replaced_;
  Parents parents_;
  Lock lock_;
  bool committed_ = false;
};

}  // namespace pregrasp
