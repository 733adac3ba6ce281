#include <CLI/CLI.hpp>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <new>
#include <string>
#include <system_error>

#include "app/commands/commands.h"
#include "app/core/error.h"
#include "app/core/file_kind.h"
#include "app/core/interrupt.h"
#include "app/core/standard_streams.h"
#include "app/core/text.h"
#include "app/recording/build_info.h"

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
  RequireValues(argc, argv);
  CLI::App app("Plans how a hand pushes, tilts and pulls an object until it can grasp it.",
               "pregrasp");
  app.require_subcommand(0, 1);
  app.set_help_flag("-h,--help", "This text");
  app.set_version_flag("--version", "pregrasp " + std::string(ProgramVersion()),
                       "The program's version");
  app.footer(
      "Exit codes: 0 done; 2 bad input, one line says what; 3 planned without success; 1 a bug of "
      "ours, or output, memory or threads that cannot be had.");
  const Subcommand command(app);
  Action action;
  AddCheck(command, action);
  AddDataset(command, action);
  AddDiff(command, action);
  AddEval(command, action);
  AddHandCommand(command, action);
  AddInfo(command, action);
  AddJobs(command, action);
  AddRepl(command, action);
  AddRun(command, action);
  AddScript(command, action);
  AddServe(command, action);
  AddShow(command, action);
  AddVerify(command, action);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& help) {
    return app.exit(help);
  } catch (const CLI::ParseError& error) {
    return Fail(kBadInput, DescribeParseError(app, error));
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
    OpenStandardStreams();
    InstallInterruptHandler();
    std::signal(SIGPIPE, SIG_IGN);  // a reader that leaves must not end the work
    const int code = Run(argc, argv);
    if (FlushStandardOutput() || code != 0) return code;  // exit code 0 says that all has arrived
    return Fail(kInternalError, std::string("standard output: cannot be written: ") +
                                    std::strerror(errno == 0 ? EIO : errno));
  } catch (const InputError& error) {
    return Fail(kBadInput, error.what());
  } catch (const Interrupted& error) {
    return Fail(kInterrupted, error.what());
  } catch (const std::filesystem::filesystem_error& error) {
    if (!IsOutOfReach(error.code())) {
      return Fail(kInternalError, std::string("pregrasp: ") + error.what());
    }
    const InputError refusal(error.path1().string(), "", "a path that can be reached",
                             error.code().message());
    return Fail(kBadInput, refusal.what());
  } catch (const std::system_error& error) {  // no more threads, a full disk, a lost file
    return Fail(kInternalError, std::string("pregrasp: ") + error.what());
  } catch (const std::bad_alloc&) {
    return Fail(kInternalError, "pregrasp: the machine has no memory left");
  } catch (const std::exception& error) {
    return Fail(kInternalError, std::string("pregrasp: a bug of ours: ") + error.what());
  }
}
