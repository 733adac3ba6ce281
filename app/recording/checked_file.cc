#include "app/recording/checked_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <system_error>
#include <utility>

#include "app/core/check.h"
#include "app/core/error.h"

namespace pregrasp {
namespace {

constexpr std::size_t kBufferSize = 1 << 16;

// An open file or folder; closed at the end.
class Descriptor {
 public:
  explicit Descriptor(const std::filesystem::path& path)
      : value_(open(path.c_str(), O_RDONLY | O_CLOEXEC)) {
    if (value_ < 0) ThrowErrno(path, "a file that can be read");
  }
  ~Descriptor() { close(value_); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int value() const { return value_; }

 private:
  int value_;
};

}  // namespace

void ThrowErrno(const std::filesystem::path& path, const char* expected) {
  throw InputError(path.string(), "", expected, std::generic_category().message(errno));
}

CheckedFile::CheckedFile(std::filesystem::path file) : file_(std::move(file)) {
  descriptor_ = open(file_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor_ < 0) ThrowErrno(file_, "a file that can be written");
}

CheckedFile::~CheckedFile() {
  if (descriptor_ >= 0) close(descriptor_);
}

void CheckedFile::Write(std::string_view bytes) {
  PREGRASP_CHECK(descriptor_ >= 0, file_);
  buffer_.append(bytes);
  if (buffer_.size() >= kBufferSize) Flush();
}

void CheckedFile::Flush() {
  std::string_view rest = buffer_;
  while (!rest.empty()) {
    const ssize_t written = write(descriptor_, rest.data(), rest.size());
    if (written < 0) {
      if (errno == EINTR) continue;
      ThrowErrno(file_, "a file that can be written");
    }
    rest.remove_prefix(static_cast<std::size_t>(written));
  }
  buffer_.clear();
}

void CheckedFile::Close() {
  PREGRASP_CHECK(descriptor_ >= 0, file_);
  Flush();
  if (close(std::exchange(descriptor_, -1)) != 0) ThrowErrno(file_, "a file that can be written");
}

void WriteFile(const std::filesystem::path& file, std::string_view bytes) {
  CheckedFile out(file);
  out.Write(bytes);
  out.Close();
}

std::string ReadFile(const std::filesystem::path& file) {
  const Descriptor descriptor(file);
  std::string bytes;
  std::array<char, kBufferSize> buffer{};
  while (true) {
    const ssize_t count = read(descriptor.value(), buffer.data(), buffer.size());
    if (count == 0) return bytes;
    if (count > 0) {
      bytes.append(buffer.data(), static_cast<std::size_t>(count));
    } else if (errno != EINTR) {
      ThrowErrno(file, "a file that can be read");
    }
  }
}

void SyncToDisk(const std::vector<std::filesystem::path>& files_and_folders) {
  // A hint, whose failure does not matter: fsync is what counts.
  for (const auto& path : files_and_folders) {
    sync_file_range(Descriptor(path).value(), 0, 0, SYNC_FILE_RANGE_WRITE);
  }
  for (const auto& path : files_and_folders) {
    const Descriptor descriptor(path);
    // A file system without fsync (some network and pseudo file systems) is not an error.
    if (fsync(descriptor.value()) != 0 && errno != EINVAL && errno != ENOTSUP && errno != ENOSYS &&
        errno != EROFS) {
      ThrowErrno(path, "a file that can be written");
    }
  }
}

void MakeFolder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directory(folder, error);
  if (error) throw InputError(folder.string(), "", "a folder that can be made", error.message());
}

void MakeLink(const std::filesystem::path& link, const std::filesystem::path& target) {
  std::error_code error;
  std::filesystem::create_symlink(target, link, error);
  if (error) throw InputError(link.string(), "", "a link that can be made", error.message());
}

}  // namespace pregrasp
