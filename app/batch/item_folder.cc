#include "app/batch/item_folder.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>

#include "app/batch/item_record.h"
#include "app/core/check.h"
#include "app/core/error.h"
#include "app/core/file_kind.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

constexpr const char* kDescriptionFile = "description.json";

// A file beside `file`, of no other process on any machine that shares the folder.
fs::path WritePartial(const fs::path& file, const std::string& text) {
  fs::path partial = file;
  partial += fmt::format(".{}.{}.partial", HostName(), getpid());
  std::ofstream out(partial, std::ios::binary | std::ios::trunc);
  out << text;
  out.close();
  if (!out) {
    std::error_code ignored;
    fs::remove(partial, ignored);
    throw InputError(file.string(), "", "a file that can be written", "a write error");
  }
  return partial;
}

// A link, unlike a renamed file, takes no other's place. Where there are no links, the last writes.
void WriteIfAbsent(const fs::path& file, const std::string& text) {
  const fs::path partial = WritePartial(file, text);
  std::error_code error, ignored;
  fs::create_hard_link(partial, file, error);
  if (error && error != std::errc::file_exists) {
    fs::rename(partial, file, error);
    if (error) throw InputError(file.string(), "", "a file that can be written", error.message());
  }
  fs::remove(partial, ignored);
}

}  // namespace

fs::path ItemPath(const fs::path& folder, std::int64_t index, const std::string& extension) {
  return folder / fmt::format("item-{:06}{}", index, extension);
}

std::string ReadWholeFile(const fs::path& file) {
  const std::string other = DescribeNonFile(file);
  if (!other.empty()) throw InputError(file.string(), "", "a readable file", other);
  std::ifstream in(file, std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  if (!in) throw InputError(file.string(), "", "a readable file", "one that cannot be read");
  return text.str();
}

void WriteWholeFile(const fs::path& file, const std::string& text) {
  const fs::path partial = WritePartial(file, text);
  std::error_code error;
  fs::rename(partial, file, error);
  if (error) throw InputError(file.string(), "", "a file that can be written", error.message());
}

void MakeFolders(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw InputError(folder.string(), "", "a folder to write to", error.message());
}

ItemFolder::ItemFolder(fs::path folder, const std::string& description, std::string extension,
                       Purpose purpose)
    : folder_(std::move(folder)), extension_(std::move(extension)) {
  const fs::path path = folder_ / kDescriptionFile;
  if (purpose == Purpose::kMake) {
    MakeFolders(folder_);
    if (!fs::exists(path)) WriteIfAbsent(path, description);
  } else if (!fs::exists(path)) {
    return;
  }
  if (const std::string there = ReadWholeFile(path); there != description) {
    throw InputError(
        folder_.string(), "", "a folder of this batch's items",
        fmt::format("one of another batch ({})", DescribeDifference(description, there)));
  }
}

fs::path ItemFolder::PathOf(std::int64_t index) const {
  return ItemPath(folder_, index, extension_);
}

bool ItemFolder::Has(std::int64_t index) const { return fs::exists(PathOf(index)); }

ItemFolders::ItemFolders(std::vector<fs::path> folders, std::string extension,
                         const std::string& what)
    : folders_(std::move(folders)), extension_(std::move(extension)) {
  PREGRASP_CHECK(!folders_.empty());
  description_ = ReadWholeFile(folders_[0] / kDescriptionFile);
  for (const fs::path& folder : folders_) {
    const std::string other = ReadWholeFile(folder / kDescriptionFile);
    if (other == description_) continue;
    throw InputError(folder.string(), "",
                     "items of the same " + what + " as " + folders_[0].string(),
                     fmt::format("another ({})", DescribeDifference(description_, other)));
  }
}

fs::path ItemFolders::Find(std::int64_t index) const {
  for (const fs::path& folder : folders_) {
    fs::path path = ItemPath(folder, index, extension_);
    if (fs::exists(path)) return path;
  }
  throw InputError(folders_[0].string(), "", "item " + std::to_string(index), "none");
}

std::string DescribeDifference(const std::string& a, const std::string& b) {
  using Json = nlohmann::ordered_json;
  if (a == b) return "";
  const Json fields_a = Json::parse(a, nullptr, false), fields_b = Json::parse(b, nullptr, false);
  if (!fields_a.is_structured() || !fields_b.is_structured()) return "description.json differs";
  const auto flat_a = fields_a.flatten(), flat_b = fields_b.flatten();
  const auto name_of = [](const std::string& pointer) {
    std::string name = pointer.substr(std::min<std::size_t>(1, pointer.size()));
    std::replace(name.begin(), name.end(), '/', '.');
    return name;
  };
  for (const auto& [pointer, value] : flat_a.items()) {
    const auto other = flat_b.find(pointer);
    if (other == flat_b.end())
      return fmt::format("{}: {} and none", name_of(pointer), value.dump());
    if (*other != value) {
      return fmt::format("{}: {} and {}", name_of(pointer), value.dump(), other->dump());
    }
  }
  for (const auto& [pointer, value] : flat_b.items()) {
    if (!flat_a.contains(pointer))
      return fmt::format("{}: none and {}", name_of(pointer), value.dump());
  }
  return "the order of the fields";
}

}  // namespace pregrasp
