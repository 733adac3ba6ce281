#include <fmt/core.h>

#include <cstdio>
#include <memory>
#include <string>

#include "app/commands/commands.h"
#include "app/core/interrupt.h"
#include "app/page/page_server.h"

namespace pregrasp {
namespace {

struct ServeOptions {
  std::string folder;
  int port = 0;
};

int Serve(const ServeOptions& options) {
  ServePages(options.folder, options.port, [&](const std::string& address) {
    fmt::print("{} shows the runs below {}; Ctrl-C ends it\n", address, options.folder);
    std::fflush(stdout);
  });
  ClearInterrupt();
  return 0;
}

}  // namespace

void AddServe(const Subcommand& app, Action& action) {
  auto options = std::make_shared<ServeOptions>();
  const Subcommand command = app.AddCommand(
      "serve", "Show the finished runs below a folder to browsers on this machine, as pages");
  command.Add("DIR", options->folder, "The folder").Required();
  command
      .Add("--port", options->port, "The port on 127.0.0.1; 0 takes a free one, which is printed")
      .Within({0, 65535, 1})
      .ShowDefault();
  command.OnChosen([options, &action] { action = [options] { return Serve(*options); }; });
}

}  // namespace pregrasp
