#include "app/core/file_kind.h"

#include <system_error>

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

constexpr const char* kNoSuchFile = "nothing of that name";

}  // namespace

std::string DescribeNonFile(const fs::path& path) {
  std::error_code error;
  switch (fs::status(path, error).type()) {
    case fs::file_type::regular:
      return "";
    case fs::file_type::not_found:
      return kNoSuchFile;
    case fs::file_type::directory:
      return "a folder";
    case fs::file_type::fifo:
      return "a pipe";
    case fs::file_type::socket:
      return "a socket";
    case fs::file_type::block:
    case fs::file_type::character:
      return "a device";
    default:  // such as a folder on the way that may not be searched, a loop of links
      return "one that cannot be reached (" + error.message() + ")";
  }
}

std::string NonFileClause(const fs::path& path) {
  std::string what = DescribeNonFile(path);
  if (what.empty()) return what;
  if (what == kNoSuchFile) return "which does not exist";
  const std::string one_that = "one that ";
  if (what.starts_with(one_that)) return "which " + what.substr(one_that.size());
  return "which is " + what;
}

bool IsOutOfReach(const std::error_code& code) {
  return code == std::errc::permission_denied || code == std::errc::not_a_directory ||
         code == std::errc::filename_too_long || code == std::errc::too_many_symbolic_link_levels;
}

}  // namespace pregrasp
