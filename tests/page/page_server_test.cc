#include "app/page/page_server.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <future>
#include <string>
#include <thread>

#include "app/core/error.h"
#include "app/core/interrupt.h"
#include "app/session/session.h"
#include "tests/job/fixture.h"
#include "tests/test_folder.h"

namespace pregrasp {
namespace {

// What a server on this machine answers, head and body.
std::string Ask(int port, const std::string& path, const std::string& host) {
  const int connection = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  inet_pton(AF_INET, "127.0.0.1", &address.sin_addr);
  std::string answer;
  if (connect(connection, reinterpret_cast<sockaddr*>(&address), sizeof(address)) == 0) {
    const std::string request = "GET " + path + " HTTP/1.1\r\nHost: " + host + "\r\n\r\n";
    EXPECT_EQ(write(connection, request.data(), request.size()),
              static_cast<ssize_t>(request.size()));
    char part[4096];
    for (ssize_t count; (count = read(connection, part, sizeof(part))) > 0;) {
      answer.append(part, static_cast<std::size_t>(count));
    }
  }
  close(connection);
  return answer;
}

TEST(PageServerTest, ListsRunsAnswersThisMachinesNamesAloneAndEndsWhenAsked) {
  const TestFolder folder;
  SessionConfig config;
  config.threads = 1;
  Session session(MakeRulerScene(), config);
  session.Save(folder.path() / "a" / "run");
  folder.Write("notes.txt", "none of the server's business");

  std::promise<std::string> address;
  std::thread server(
      [&] { ServePages(folder.path(), 0, [&](const std::string& at) { address.set_value(at); }); });
  const std::string at = address.get_future().get();
  EXPECT_EQ(at.rfind("http://127.0.0.1:", 0), 0U) << at;
  const int port = std::stoi(at.substr(17));
  const std::string local = "localhost:" + std::to_string(port);
  const std::string list = Ask(port, "/", local);
  EXPECT_NE(list.find("200 OK"), std::string::npos) << list;
  EXPECT_NE(list.find("<a href=\"/run/a/run\">a/run</a>"), std::string::npos) << list;
  EXPECT_NE(list.find("<td>ruler</td>"), std::string::npos);
  EXPECT_NE(Ask(port, "/", "127.0.0.1").find("200 OK"), std::string::npos);
  EXPECT_NE(Ask(port, "/", "elsewhere.example").find(" 403 "), std::string::npos);
  for (const char* path : {"/run/b", "/notes.txt", "/run/../notes.txt", "/run/a/run/scene.json"}) {
    EXPECT_NE(Ask(port, path, local).find(" 404 "), std::string::npos) << path;
  }
  EXPECT_THROW(ServePages(folder.path(), port, [](const std::string&) {}), InputError);
  RequestInterrupt();
  server.join();
  ClearInterrupt();
  EXPECT_EQ(Ask(port, "/", local), "");
}

}  // namespace
}  // namespace pregrasp
