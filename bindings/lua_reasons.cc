#include "bindings/lua_planner.h"

namespace pregrasp {
namespace {

const Schema kExplanation{"Explanation", {"text", "verdict", "items"}};
const Schema kExplanationItem{"ExplanationItem",
                              {"name", "value", "other", "limit", "unit", "met"}};

}  // namespace

Pushed PushExplanation(lua_State* L, const Explanation& why) {
  RecordWriter record(L, kExplanation);
  record.Set("text", why.text).Set("verdict", why.verdict);
  lua_createtable(L, static_cast<int>(why.items.size()), 0);
  for (std::size_t i = 0; i < why.items.size(); ++i) {
    const Explanation::Item& item = why.items[i];
    RecordWriter(L, kExplanationItem)
        .Set("name", item.name)
        .Set("value", item.value)
        .Set("other", item.other)
        .Set("limit", item.limit)
        .Set("unit", item.unit)
        .Set("met", item.met);
    lua_rawseti(L, -2, static_cast<lua_Integer>(i) + 1);
  }
  record.SetTop("items");
  return {1};
}

std::vector<const Schema*> ReasonSchemas() { return {&kExplanation, &kExplanationItem}; }

}  // namespace pregrasp
