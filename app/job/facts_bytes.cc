#include "app/job/facts_bytes.h"

#include "app/job/fields_json.h"

namespace pregrasp {
namespace {

// Of a command: a JSON object with a few numbers.
constexpr std::size_t kCommandBytes = 500;
// Of a physics step of a simulation by hand: the state and the contacts.
constexpr std::size_t kPhysicsStepBytes = 3000;

// What a value holds beside itself: one overload a type.
template <typename T>
std::size_t Beside(const std::vector<T>& values);
template <typename T>
std::size_t Beside(const std::optional<T>& value);
std::size_t Beside(const std::string& text) {
  const bool inside = text.capacity() <= std::string().capacity();
  return inside ? 0 : text.capacity() + 1;
}
std::size_t Beside(const TriangleMesh& mesh) {
  return sizeof(double) * mesh.V.size() + sizeof(int) * mesh.F.size();
}
template <typename T>
std::size_t Beside(const T& value) {
  std::size_t bytes = 0;
  if constexpr (fields::HasFields<T>) {
    T::VisitFields(value, [&](const char*, const auto& field) { bytes += Beside(field); });
  }
  return bytes;
}
template <typename T>
std::size_t Beside(const std::optional<T>& value) {
  return value ? Beside(*value) : 0;
}
template <typename T>
std::size_t Beside(const std::vector<T>& values) {
  std::size_t bytes = values.capacity() * sizeof(T);
  for (const T& value : values) bytes += Beside(value);
  return bytes;
}

}  // namespace

std::size_t CalcBytes(const StepFacts& facts) {
  const std::size_t details =
      std::visit([](const auto& of_stage) { return Beside(of_stage); }, facts.details);
  return sizeof(StepFacts) + 2 * kCommandBytes + Beside(facts.bodies) + Beside(facts.fingers) +
         Beside(facts.contacts) + details;
}

std::size_t CalcPastBytes(const StepFacts& facts) {
  const auto* simulated = std::get_if<SimulationFacts>(&facts.details);
  return simulated == nullptr ? 0 : kPhysicsStepBytes * simulated->physics_steps;
}

}  // namespace pregrasp
