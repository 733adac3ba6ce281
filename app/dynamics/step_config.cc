#include "app/dynamics/step_config.h"

#include "app/core/error.h"
#include "app/core/text.h"

namespace pregrasp {
namespace {

void RequireRange(const char* field, double value, double low, double high) {
  if (!(value >= low && value <= high)) {
    throw InputError("dynamics", field,
                     "a number from " + FormatDouble(low) + " to " + FormatDouble(high),
                     FormatDouble(value));
  }
}

}  // namespace

void StepConfig::Validate() const {
  RequireRange("dt", dt, 1e-6, 0.02);
  RequireRange("tolerance", tolerance, 0.0, 1.0);
  RequireRange("tolerance_many", tolerance_many, 0.0, 1.0);
  RequireRange("max_sweeps", max_sweeps, 1, 1e6);
  RequireRange("max_sweeps_many", max_sweeps_many, 1, 1e6);
  RequireRange("margin", margin, 0.0, 0.01);
  RequireRange("restitution", restitution, 0.0, 1.0);
}

}  // namespace pregrasp
