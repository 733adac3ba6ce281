#include "app/recording/trace_table.h"

#include "app/core/json_text.h"
#include "app/core/json_values.h"

namespace pregrasp {

nlohmann::ordered_json TraceToJson(const StepTrace& trace, const Scene& scene) {
  nlohmann::ordered_json value;
  nlohmann::ordered_json contacts = nlohmann::ordered_json::array();
  for (const ContactPoint& contact : trace.contacts) {
    contacts.push_back({{"a", scene.bodies[contact.body_a.value].name},
                        {"b", scene.bodies[contact.body_b.value].name},
                        {"p_W", ToJson(contact.p_WC)},
                        {"nhat_W", ToJson(contact.nhat_W)},
                        {"f_W", ToJson(contact.f_W)},
                        {"gap", contact.phi},
                        {"v_slip_W", ToJson(contact.v_slip_W)}});
  }
  value["contacts"] = std::move(contacts);
  value["max_penetration"] = trace.max_penetration;
  value["kinetic_energy"] = trace.kinetic_energy;
  value["potential_energy"] = trace.potential_energy;
  return value;
}

std::string FormatTraceRow(const StepTrace& trace, double t, const Scene& scene) {
  nlohmann::ordered_json row;
  row["t"] = t;
  row.update(TraceToJson(trace, scene));
  return FormatJson(row) + "\n";
}

}  // namespace pregrasp
