#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

namespace pregrasp {

/// The finished runs below a folder, by their paths in it, in order; the folder itself is ".".
std::vector<std::filesystem::path> FindRuns(const std::filesystem::path& folder);

/// Shows the runs below a folder to browsers on this machine: a list, and each run's page, made
/// when it is asked for. Listens on the loopback interface alone and answers no request that names
/// another host, so that nobody else's page can read what is here. Serves nothing but these pages.
///
/// Returns when somebody asks the program to stop (Interrupted is not thrown).
/// @param port      0 takes a free one.
/// @param listening called once with the address, when it can be asked.
/// @throws InputError if `folder` is none, or the port cannot be had.
void ServePages(const std::filesystem::path& folder, int port,
                const std::function<void(const std::string& address)>& listening);

}  // namespace pregrasp
