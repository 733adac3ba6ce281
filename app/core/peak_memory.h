#pragma once

namespace pregrasp {

/// The most memory that this process had so far, in MB of 2^20 bytes.
double PeakMegabytes();

}  // namespace pregrasp
