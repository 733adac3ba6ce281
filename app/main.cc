#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <string>

#include "app/commands/commands.h"
#include "app/core/error.h"
#include "app/core/interrupt.h"
#include "app/core/text.h"

namespace pregrasp {
namespace {

// Exit codes, the same for all commands.
constexpr int kInternalError = 1;
constexpr int kBadInput = 2;
constexpr int kInterrupted = 130;  // as shells have it for SIGINT

int Fail(int code, const std::string& message) {
  std::fflush(stdout);
  std::fprintf(stderr, "%s\n", OneLine(message).c_str());
  return code;
}

int Run(int argc, char** argv) {
  CLI::App app("Plans how a hand pushes, tilts and pulls an object until it can grasp it.",
               "pregrasp");
  app.require_subcommand(0, 1);
  app.set_help_flag("-h,--help", "This text");
  app.footer(
      "Exit codes: 0 done; 2 bad input, one line says what; 3 planned without success; 1 a bug of "
      "ours.");
  const Subcommand command(app);
  Action action;
  AddCheck(command, action);
  AddDataset(command, action);
  AddDiff(command, action);
  AddEval(command, action);
  AddInfo(command, action);
  AddRepl(command, action);
  AddRun(command, action);
  AddScript(command, action);
  AddShow(command, action);
  AddVerify(command, action);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& help) {
    return app.exit(help);
  } catch (const CLI::ParseError& error) {
    return Fail(kBadInput, std::string("pregrasp: ") + error.what() + " (see pregrasp --help)");
  }
  if (!action) {
    std::fputs(app.help().c_str(), stdout);
    return 0;
  }
  return action();
}

}  // namespace
}  // namespace pregrasp

int main(int argc, char** argv) {
  using namespace pregrasp;  // NOLINT: the program's own namespace
  try {
    InstallInterruptHandler();
    return Run(argc, argv);
  } catch (const InputError& error) {
    return Fail(kBadInput, error.what());
  } catch (const Interrupted& error) {
    return Fail(kInterrupted, error.what());
  } catch (const std::exception& error) {
    return Fail(kInternalError, std::string("pregrasp: a bug of ours: ") + error.what());
  }
}
