#pragma once

#include <string>

namespace pregrasp {

/// The shortest text that reads back as the same double ("0.1", "1e-09", "nan"); the same on every
/// machine.
std::string FormatDouble(double value);

}  // namespace pregrasp
