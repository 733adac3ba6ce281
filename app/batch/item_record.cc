#include "app/batch/item_record.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <nlohmann/json.hpp>
#include <vector>

#include "app/batch/item_folder.h"
#include "app/batch/shell_words.h"
#include "app/core/json_reader.h"
#include "app/core/json_text.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

fs::path RecordPath(const fs::path& folder, std::int64_t item) {
  return ItemPath(folder, item, ".json");
}

// The running program's command line with another shard: a shard of as many as there are items is
// one item.
std::string ItemCommand(std::int64_t item, std::int64_t items) {
  std::ifstream in("/proc/self/cmdline", std::ios::binary);
  std::vector<std::string> words;
  for (std::string word; std::getline(in, word, '\0');) words.push_back(word);
  std::vector<std::string> kept;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i] == "--shard") {
      ++i;
    } else if (words[i].rfind("--shard=", 0) != 0) {
      kept.push_back(words[i]);
    }
  }
  kept.insert(kept.end(), {"--shard", fmt::format("{}/{}", item + 1, items)});
  return ShellWords(kept);
}

std::string LogFile() {
  std::error_code error;
  const fs::path file = fs::read_symlink("/proc/self/fd/2", error);
  return !error && fs::is_regular_file(file, error) ? file.string() : "";
}

}  // namespace

std::string HostName() {
  std::array<char, 256> name{};
  gethostname(name.data(), name.size() - 1);
  return name.data();
}

ItemRecord BeginRecord(std::int64_t item, std::int64_t items) {
  ItemRecord record;
  record.item = item;
  record.host = HostName();
  record.log = LogFile();
  std::error_code error;
  record.directory = fs::current_path(error).string();
  record.command = ItemCommand(item, items);
  return record;
}

void WriteRecord(const fs::path& folder, const ItemRecord& record) {
  const nlohmann::ordered_json json = {{"item", record.item},
                                       {"verdict", record.verdict},
                                       {"text", record.text},
                                       {"seconds", record.seconds},
                                       {"peak_rss_mb", record.peak_rss_mb},
                                       {"host", record.host},
                                       {"log", record.log},
                                       {"directory", record.directory},
                                       {"command", record.command}};
  using Json = nlohmann::ordered_json;
  WriteWholeFile(RecordPath(folder, record.item),
                 json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
}

std::optional<ItemRecord> ReadRecord(const fs::path& folder, std::int64_t item) {
  const fs::path file = RecordPath(folder, item);
  if (!fs::exists(file)) return std::nullopt;
  const nlohmann::json json = ParseJson(ReadWholeFile(file), file.string());
  const JsonReader fields(json, file.string());
  ItemRecord record;
  record.item = item;
  record.verdict = fields["verdict"].Text();
  record.text = fields["text"].Text();
  record.seconds = fields["seconds"].Number();
  record.peak_rss_mb = fields["peak_rss_mb"].Number();
  record.host = fields["host"].Text();
  record.log = fields["log"].Text();
  record.directory = fields["directory"].Text();
  record.command = fields["command"].Text();
  return record;
}

}  // namespace pregrasp
