#pragma once

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <vector>

#include "app/job/fields_json.h"

namespace pregrasp {

/// A study's items as the structs that they were written from. @throws InputError for a damaged
/// one, with its number and the field.
template <typename Facts>
std::vector<Facts> ReadItems(const std::vector<nlohmann::json>& items) {
  std::vector<Facts> facts(items.size());
  for (std::size_t i = 0; i < items.size(); ++i) {
    fields::Read(JsonReader(items[i], fmt::format("item {}", i)), facts[i]);
  }
  return facts;
}

}  // namespace pregrasp
