#include "app/page/page_server.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <map>
#include <thread>
#include <vector>

#include "app/core/error.h"
#include "app/core/interrupt.h"
#include "app/page/html_text.h"
#include "app/page/page.h"
#include "app/recording/loaded_run.h"
#include "app/recording/manifest.h"
#include "app/recording/summary.h"

// Last: the system's resolv.h, which it reads, has a macro _res, and Eigen has parameters of that
// name.
#include <httplib.h>

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

constexpr int kDeepest = 6;  // folders in folders that are looked into

void FindRunsIn(const fs::path& folder, const fs::path& name, int depth,
                std::vector<fs::path>& found) {
  if (IsFinishedRun(folder)) {
    found.push_back(name.empty() ? fs::path(".") : name);
    return;
  }
  if (depth == kDeepest) return;
  std::error_code error;
  std::vector<fs::path> inner;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    std::error_code unknown;
    const std::string file = entry.path().filename().string();
    if (!file.empty() && file[0] != '.' && entry.is_directory(unknown) &&
        !entry.is_symlink(unknown)) {
      inner.push_back(entry.path());
    }
  }
  std::sort(inner.begin(), inner.end());
  for (const fs::path& next : inner) {
    FindRunsIn(next, name / next.filename(), depth + 1, found);
  }
}

// "a/b c" as the path of an address.
std::string UrlPath(const std::string& path) {
  std::string url;
  for (const char c : path) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       std::string("-._~/").find(c) != std::string::npos;
    url += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return url;
}

std::string ListPage(const fs::path& folder) {
  std::vector<std::vector<std::string>> rows;
  for (const fs::path& name : FindRuns(folder)) {
    std::vector<std::string> row = {fmt::format("<a href=\"/run/{}\">{}</a>",
                                                UrlPath(name.string()), EscapeHtml(name.string()))};
    try {
      const RunSummary summary = LoadSummary(folder / name / "summary.json");
      const auto seconds = summary.seconds.total;
      row.insert(row.end(), {EscapeHtml(summary.scene), std::to_string(summary.seed),
                             EscapeHtml(summary.status.value_or("no plan")),
                             seconds ? fmt::format("{:.1f} s", *seconds) : ""});
    } catch (const InputError& error) {
      row.insert(row.end(), {"", "", EscapeHtml(error.what()), ""});
    }
    rows.push_back(std::move(row));
  }
  const std::string title = EscapeHtml("Runs in " + folder.string());
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>" + title +
         "</title>\n<meta name=\"color-scheme\" content=\"light dark\">\n<style>\n" +
         PageAsset("page.css") +
         "</style>\n</head>\n<body>\n<header><p class=\"where\">pregrasp</p><h1>" + title +
         "</h1></header>\n<main>\n" +
         (rows.empty() ? "<p>There is no finished run.</p>\n"
                       : HtmlTable("", {"run", "scene", "seed", "status", "time"}, rows)) +
         "</main>\n</body>\n</html>\n";
}

bool IsLocalHost(const std::string& host) {
  const std::string name = host.substr(0, host.rfind(':'));
  return name == "127.0.0.1" || name == "localhost";
}

// Answers in the thread that listens: pictures are drawn by one renderer, which is its thread's.
class OneAfterAnother : public httplib::TaskQueue {
 public:
  void enqueue(std::function<void()> task) override { task(); }
  void shutdown() override {}
};

// Pages that were made already, for as long as their run is the same.
class Pages {
 public:
  const std::string& Get(const fs::path& run) {
    const fs::file_time_type time = fs::last_write_time(run / "manifest.json");
    const auto known = made_.find(run);
    if (known != made_.end() && known->second.first == time) return known->second.second;
    constexpr std::size_t kMost = 16;
    if (made_.size() >= kMost) made_.clear();
    return (made_[run] = {time, MakePage(LoadRun(run))}).second;
  }

 private:
  std::map<fs::path, std::pair<fs::file_time_type, std::string>> made_;
};

// Runs the server until somebody interrupts the program.
class Watch {
 public:
  explicit Watch(httplib::Server& server)
      : thread_([this, &server] {
          while (!done_ && !InterruptRequested()) {
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
          }
          server.stop();
        }) {}
  ~Watch() {
    done_ = true;
    thread_.join();
  }
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;

 private:
  std::atomic<bool> done_ = false;
  std::thread thread_;
};

}  // namespace

std::vector<fs::path> FindRuns(const fs::path& folder) {
  std::vector<fs::path> found;
  FindRunsIn(folder, "", 0, found);
  return found;
}

void ServePages(const fs::path& folder, int port,
                const std::function<void(const std::string& address)>& listening) {
  std::error_code error;
  if (!fs::is_directory(folder, error)) {
    throw InputError(folder.string(), "", "a folder with runs", "none");
  }
  httplib::Server server;
  server.new_task_queue = [] { return new OneAfterAnother; };
  server.set_keep_alive_max_count(1);
  // A port that another program has is taken: the library would share it.
  server.set_socket_options([](socket_t socket) {
    const int yes = 1;
    setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
  });
  server.set_pre_routing_handler([](const httplib::Request& request, httplib::Response& response) {
    if (IsLocalHost(request.get_header_value("Host"))) {
      return httplib::Server::HandlerResponse::Unhandled;
    }
    response.status = 403;
    response.set_content("asked for by another host's name\n", "text/plain");
    return httplib::Server::HandlerResponse::Handled;
  });
  Pages pages;
  const std::string html = "text/html; charset=utf-8";
  server.Get("/", [&](const httplib::Request&, httplib::Response& response) {
    response.set_content(ListPage(folder), html);
  });
  server.Get("/run/(.+)", [&](const httplib::Request& request, httplib::Response& response) {
    const std::string asked = request.matches[1];
    for (const fs::path& name : FindRuns(folder)) {
      if (name.string() != asked) continue;
      try {
        response.set_content(pages.Get(folder / name), html);
      } catch (const InputError& problem) {
        response.status = 500;
        response.set_content(std::string(problem.what()) + '\n', "text/plain; charset=utf-8");
      }
      return;
    }
    response.status = 404;
    response.set_content("there is no such run\n", "text/plain; charset=utf-8");
  });
  const std::string host = "127.0.0.1";
  if (port == 0)
    port = server.bind_to_any_port(host.c_str());
  else if (!server.bind_to_port(host.c_str(), port))
    port = -1;
  if (port < 0) throw InputError("--port", "", "a port that is free", "one that is taken");
  listening(fmt::format("http://{}:{}/", host, port));
  const Watch watch(server);
  server.listen_after_bind();
}

}  // namespace pregrasp
