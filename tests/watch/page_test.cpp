// The page of `watch --serve` in a browser, and its server under requests of all kinds.
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <httplib.h>
#include <sys/socket.h>
#include <unistd.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <random>

#include "tests/cli/program.h"
#include "tests/watch/browser.h"
#include "tests/watch/child.h"

namespace solidcast::watch_test {
namespace {

using namespace cli_test;
using Json = nlohmann::json;

class Page : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { browser_ = new Browser; }
  static void TearDownTestSuite() {
    delete browser_;
    browser_ = nullptr;
  }

  Page() {
    save("1");
    watch.emplace(std::vector<std::string>{"watch", "ball.json", "--serve", "0", "--device", "llvmpipe"},
                  folder.path());
    const std::string line = watch->waitFor("http://127.0.0.1:");
    url = line.substr(line.find("http"));
    url = url.substr(0, url.find(' '));
    port = std::stoi(url.substr(17));
    EXPECT_FALSE(watch->waitFor("ball.png (1)").empty()) << watch->said();
  }

  void save(const std::string& radius) {
    std::string scene = smallScene();
    scene.replace(scene.find("\"radius\": 1"), 11, "\"radius\": " + radius);
    writeFile(folder / "ball.json", scene);
  }
  /// The watch goes on: another save gives another image.
  void expectAlive(const std::string& radius) {
    save(radius);
    EXPECT_FALSE(watch->waitFor("ball.png (").empty()) << watch->said();
  }
  httplib::Client client() {
    httplib::Client http("127.0.0.1", port);
    http.set_read_timeout(30, 0);
    return http;
  }
  int status(const std::string& path, const httplib::Headers& headers = {}) {
    const auto answer = client().Get(path, headers);
    return answer ? answer->status : 0;
  }

  static inline Browser* browser_ = nullptr;
  Folder folder;
  std::optional<Child> watch;
  std::string url;
  int port = 0;
};

TEST_F(Page, ShowsWhatIsSaved) {
  browser_->open(url);
  EXPECT_TRUE(browser_->becomes("at('gpu').dataset.frame === '1' && at('gpu').naturalWidth === 64"));
  EXPECT_TRUE(browser_->becomes("at('phases').textContent.includes('pipelines made')"));
  EXPECT_TRUE(browser_->becomes("document.title.includes('ball.json')"));
  save("2");
  EXPECT_TRUE(browser_->becomes("at('gpu').dataset.frame === '2'"));
  save("-2");
  EXPECT_TRUE(browser_->becomes("!at('problems').hidden && at('problems').textContent.includes('-2 is not positive')"));
  EXPECT_TRUE(browser_->becomes("at('problems').textContent.includes('ball.json:4')"));
  EXPECT_TRUE(browser_->becomes("at('status').textContent === 'last good image' && at('gpu').dataset.frame === '2'"));
  save("0.5");
  EXPECT_TRUE(browser_->becomes("at('problems').hidden && at('gpu').dataset.frame === '3'"));
}

TEST_F(Page, ExplainsThePixelThatIsClicked) {
  browser_->open(url);
  ASSERT_TRUE(browser_->becomes("at('gpu').dataset.frame === '1'"));
  browser_->pointer("#stage");
  EXPECT_TRUE(browser_->becomes("/^\\(3[12], 2[34]\\) both are right/.test(at('pixel').textContent)"))
      << browser_->value("at('pixel').textContent");
  EXPECT_TRUE(browser_->becomes("at('pixel').textContent.includes('ball') && !at('cross').hidden"));
  EXPECT_EQ(browser_->value("state.frame.number"), "1");
}

TEST_F(Page, ComparesWithTheReference) {
  browser_->open(url);
  ASSERT_TRUE(browser_->becomes("at('gpu').dataset.frame === '1'"));
  browser_->key("4");
  EXPECT_TRUE(browser_->becomes("!at('difference').hidden && at('difference').naturalWidth === 64"));
  EXPECT_TRUE(browser_->becomes("at('legend').textContent.includes('pixel')"));
  save("0.7");
  EXPECT_TRUE(browser_->becomes("at('difference').dataset.frame === '2'"));
  browser_->value("(at('legend').querySelector('button') ?? {click() { explain(1, 1); }}).click()");
  EXPECT_TRUE(browser_->becomes("at('pixel').textContent.includes('truth')"));
  browser_->key("3");
  EXPECT_TRUE(browser_->becomes("at('cpu').style.clipPath.includes('50%') && !at('sliderRow').hidden"));
}

TEST_F(Page, MovesTheCamera) {
  browser_->open(url);
  ASSERT_TRUE(browser_->becomes("at('gpu').dataset.frame === '1'"));
  browser_->pointer("#stage", 20, 5);
  EXPECT_TRUE(browser_->becomes("state.camera_moved && state.frame.number >= 2 && state.frame.pipelines_made === 0"));
  EXPECT_TRUE(browser_->becomes("at('pixel').textContent.includes('Click the picture')"));
  const Json camera = Json::parse(client().Get("/camera")->body);
  EXPECT_NE(camera.at("center").at(0), 0);
  browser_->key("r");
  EXPECT_TRUE(browser_->becomes("state.camera_moved === false"));
  EXPECT_EQ(Json::parse(client().Get("/camera")->body).at("center"), (Json{0, 0, 5}));
  browser_->key("+");
  EXPECT_TRUE(browser_->becomes("state.camera_moved"));
  EXPECT_NEAR(Json::parse(client().Get("/camera")->body).at("center").at(2).get<double>(), 4.5, 1e-12);
}

TEST_F(Page, SwitchesTheMethod) {
  browser_->open(url);
  ASSERT_TRUE(browser_->becomes("at('gpu').dataset.frame === '1'"));
  browser_->value("(at('method').value = 'naive', at('method').dispatchEvent(new Event('change')), 1)");
  EXPECT_TRUE(browser_->becomes("state.method === 'naive' && state.frame.number === 2"));
}

TEST_F(Page, SecondBrowserAndAClosedOne) {
  browser_->open(url);
  ASSERT_TRUE(browser_->becomes("at('gpu').dataset.frame === '1'"));
  {
    Browser second;
    second.open(url);
    EXPECT_TRUE(second.becomes("at('gpu').dataset.frame === '1'"));
    save("0.9");
    EXPECT_TRUE(second.becomes("at('gpu').dataset.frame === '2'"));
    EXPECT_TRUE(browser_->becomes("at('gpu').dataset.frame === '2'"));
  }
  save("0.8");
  EXPECT_TRUE(browser_->becomes("at('gpu').dataset.frame === '3'"));
  watch->signal(SIGINT);
  EXPECT_EQ(watch->end(std::chrono::seconds(15)), 0) << watch->said();
  EXPECT_TRUE(browser_->becomes("at('status').textContent === 'the watch does not answer'"));
}

TEST_F(Page, OnlyItsOwnRoutesAndGuests) {
  const std::string here = "127.0.0.1:" + std::to_string(port);
  EXPECT_EQ(status("/"), 200);
  EXPECT_EQ(status("/state"), 200);
  EXPECT_EQ(status("/state", {{"Host", "localhost:" + std::to_string(port)}}), 200);
  for (const char* path :
       {"/ball.json", "/../ball.json", "/%2e%2e/ball.json", "//", "/page.html", "/state/", "/gpu.png/x"})
    EXPECT_EQ(status(path), 404) << path;
  for (const std::string& host : {std::string("evil.example"), "evil.example:" + std::to_string(port),
                                  std::string("127.0.0.1:1"), std::string("127.0.0.1.evil.example"), std::string("")})
    EXPECT_EQ(status("/state", {{"Host", host}}), 421) << host;
  EXPECT_EQ(status("/state", {{"Host", here}, {"Origin", "http://evil.example"}}), 403);
  EXPECT_EQ(status("/state", {{"Host", here}, {"Origin", "null"}}), 403);
  EXPECT_EQ(status("/state", {{"Host", here}, {"Origin", "http://" + here}}), 200);
  EXPECT_EQ(status("/gpu.png", {{"Host", here}, {"Sec-Fetch-Site", "cross-site"}}), 403);
  EXPECT_EQ(status("/gpu.png", {{"Host", here}, {"Range", "bytes=0-1,0-1"}}), 400);

  httplib::Client http = client();
  EXPECT_EQ(http.Post("/camera", "{\"zoom\": 0.9}", "text/plain")->status, 415);
  EXPECT_EQ(http.Post("/camera", {{"Origin", "http://evil.example"}}, "{\"zoom\": 0.9}", "application/json")->status,
            403);
  EXPECT_EQ(http.Post("/camera", std::string(100'000, ' '), "application/json")->status, 413);
  EXPECT_EQ(http.Post("/state", "{}", "application/json")->status, 404);
  EXPECT_EQ(http.Delete("/state")->status, 405);
  for (const char* body :
       {"", "{", "[]", "{}", "{\"zoom\": 0}", "{\"zoom\": 1e9}", "{\"zoom\": \"1\"}", "{\"orbit\": [1]}",
        "{\"orbit\": [1e300, 0]}", "{\"pan\": [null, 0]}", "{\"reset\": 1}", "{\"zoom\": 1, \"reset\": true}"})
    EXPECT_EQ(http.Post("/camera", body, "application/json")->status, 400) << body;
  for (const char* body : {"", "{}", "{\"method\": 3}", "{\"method\": \"best\"}", "{\"integrator\": \"castingdist\"}"})
    EXPECT_EQ(http.Post("/view", body, "application/json")->status, 400) << body;
  for (const char* query :
       {"", "?x=1", "?x=1&y=", "?x=64&y=0", "?x=-1&y=0", "?x=1e1&y=2", "?x=99999999999999999999&y=1"})
    EXPECT_EQ(status(std::string("/pixel") + query), 400) << query;
  EXPECT_EQ(Json::parse(client().Get("/state")->body).at("frame").at("number"), 1)
      << "nothing of this changed the view";
  expectAlive("0.6");
}

TEST_F(Page, GarbageDoesNotStopTheWatch) {
  std::mt19937 random(7);
  const auto connected = [this](int flags) {
    const int connection = ::socket(AF_INET, SOCK_STREAM | flags, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const int done = ::connect(connection, reinterpret_cast<sockaddr*>(&address), sizeof address);
    EXPECT_TRUE(done == 0 || errno == EINPROGRESS);
    return connection;
  };
  const std::string parts[] = {"GET ",
                               "POST ",
                               "/state?after=0",
                               "/%zz%00",
                               " HTTP/1.1\r\n",
                               "Host: 127.0.0.1\r\n",
                               "\r\n\r\n",
                               "Content-Length: 99999999999999999999\r\n",
                               std::string(20'000, 'a'),
                               std::string(1, '\0'),
                               "Transfer-Encoding: chunked\r\n",
                               "ffffffffffffffff\r\n",
                               "\xff\xfe{\"zoom\":"};
  for (int i = 0; i < 1000; ++i) {
    const int connection = connected(0);
    std::string garbage;
    for (unsigned n = random() % 6; n > 0; --n) garbage += parts[random() % std::size(parts)];
    for (unsigned n = random() % 40; n > 0; --n) garbage += static_cast<char>(random());
    [[maybe_unused]] const auto sent = ::send(connection, garbage.data(), garbage.size(), MSG_NOSIGNAL);
    ::close(connection);  // without waiting for an answer
  }
  expectAlive("0.6");
  EXPECT_EQ(status("/state"), 200);
  // Many that connect and say nothing, or wait for news: they get in each other's way, not in the watch's.
  std::vector<int> silent;
  for (int i = 0; i < 200; ++i) {
    silent.push_back(connected(SOCK_NONBLOCK));
    const std::string text = "GET /state?after=99 HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n";
    if (i % 2 == 0) [[maybe_unused]]
      const auto sent = ::send(silent.back(), text.data(), text.size(), MSG_NOSIGNAL);
  }
  expectAlive("0.5");
  for (const int connection : silent) ::close(connection);
  EXPECT_EQ(status("/state"), 200);
  EXPECT_LT(watch->kilobytes(), 400'000);
}

TEST(Serve, PortsThatCannotBe) {
  Folder folder;
  writeFile(folder / "ball.json", smallScene());
  for (const char* port : {"65536", "-1", "8o8o"})
    expectError(run({"watch", folder / "ball.json", std::string("--serve=") + port}), 2, {"--serve", port});
  const int taken = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  ASSERT_EQ(::bind(taken, reinterpret_cast<sockaddr*>(&address), size), 0);
  ASSERT_EQ(::listen(taken, 1), 0);
  ::getsockname(taken, reinterpret_cast<sockaddr*>(&address), &size);
  expectError(run({"watch", folder / "ball.json", "--serve", std::to_string(ntohs(address.sin_port))}), 2,
              {"--serve", "cannot be had"}, false);
  ::close(taken);
}

}  // namespace
}  // namespace solidcast::watch_test
