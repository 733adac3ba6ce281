#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace pregrasp {

/// How an item was made, in a file beside the items. It cannot change them: it is for who asks what
/// became of a batch on many machines.
struct ItemRecord {
  std::int64_t item = 0;
  /// "begun", then "done", "failed" or "interrupted": written before the item is made and after it,
  /// so that what a kill leaves is "begun".
  std::string verdict = "begun";
  std::string text;                ///< a line about the item, or why it failed
  double seconds = 0.0;            ///< on the clock
  double peak_rss_mb = 0.0;        ///< of the process, from its start to the item's end
  std::string host, log;           ///< log: the file that its stderr was, if it was one
  std::string directory, command;  ///< in `directory`, `command` makes this item alone
};

/// A record with host, log, directory and command of the running program, which makes `item` of
/// `items` of a batch.
ItemRecord BeginRecord(std::int64_t item, std::int64_t items);

/// @throws InputError.
void WriteRecord(const std::filesystem::path& folder, const ItemRecord& record);
/// None if there is no such file. @throws InputError for a file that is no record.
std::optional<ItemRecord> ReadRecord(const std::filesystem::path& folder, std::int64_t item);

std::string HostName();

}  // namespace pregrasp
