#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace pregrasp {

/// The whole of a file. @throws InputError if it cannot be read.
std::string ReadWholeFile(const std::filesystem::path& file);

/// Writes a file that appears at once and whole, so that what a kill leaves is the old file, the
/// new one or none. @throws InputError.
void WriteWholeFile(const std::filesystem::path& file, const std::string& text);

/// FOLDER/item-000012.EXT.
std::filesystem::path ItemPath(const std::filesystem::path& folder, std::int64_t index,
                               const std::string& extension);

/// With the folders above it, where they are not there. @throws InputError.
void MakeFolders(const std::filesystem::path& folder);

/// A folder in which the items of a batch are being made, one file each: ITEM-000012.EXT. A file
/// that is there is its item's completion record, because it appears whole; so a batch that was cut
/// off goes on where it was, and shards of it can be made anywhere. description.json says what
/// decides the items.
class ItemFolder {
 public:
  /// What a folder is opened for: to make items, which makes the folder if it is not there; or to
  /// look at those it has, which writes nothing.
  enum class Purpose { kMake, kLook };

  /// @param description  JSON on one line. @param extension  of an item's file, ".json".
  /// @throws InputError if the folder holds items of another description, naming the first field
  /// that differs. Of programs that begin at the same time with different descriptions one goes on.
  ItemFolder(std::filesystem::path folder, const std::string& description, std::string extension,
             Purpose purpose = Purpose::kMake);

  std::filesystem::path PathOf(std::int64_t index) const;
  bool Has(std::int64_t index) const;

 private:
  std::filesystem::path folder_;
  std::string extension_;
};

/// The items of one batch in the folders that its shards were made in.
class ItemFolders {
 public:
  /// @param what  of which the items are parts, for messages: "data set".
  /// @throws InputError if a folder has no description, or another than the first one.
  ItemFolders(std::vector<std::filesystem::path> folders, std::string extension,
              const std::string& what);

  const std::string& description() const { return description_; }

  /// The first folder's file. @throws InputError if none has the item.
  std::filesystem::path Find(std::int64_t index) const;

 private:
  std::vector<std::filesystem::path> folders_;
  std::string extension_, description_;
};

/// The first field in which two descriptions differ, with both values: "seed: 1 and 2"; "" where
/// they are equal. Text that is no JSON differs as a whole.
std::string DescribeDifference(const std::string& a, const std::string& b);

}  // namespace pregrasp
