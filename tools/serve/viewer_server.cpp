// SPDX-License-Identifier: GPL-3.0-or-later
#include "serve/viewer_server.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <fmt/format.h>
#include <httplib.h>
#include <memory>
#include <stdexcept>
#include <string_view>
#include <sys/socket.h>
#include <thread>
#include <utility>

#include "base/errors.h"
#include "base/files.h"
#include "base/interruption.h"
#include "serve/asset_list.h"
#include "serve/served_file.h"
#include "serve/viewer_files.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

constexpr const char* loopback = "127.0.0.1";
constexpr const char* page = "index.html";

/// What the page may load: itself, compiled WebAssembly, and pictures and workers that it makes of what it loaded.
/// Styles in elements are those that its controls set.
constexpr const char* content_policy =
    "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; worker-src 'self' blob:; style-src 'self' "
    "'unsafe-inline'; "
    "img-src 'self' blob: data:; connect-src 'self' blob: data:; base-uri 'none'; form-action 'none'; "
    "frame-ancestors 'none'";

enum Status { forbidden = 403, not_found = 404, wrong_method = 405 };

void tell(httplib::Response& response, int status, const std::string& text) {
  response.status = status;
  response.set_content(text + "\n", "text/plain; charset=utf-8");
}

/// Sends bytes as they are: httplib compresses whole texts by Brotli's best, 1.7 s for the page's script, and nothing
/// travels here.
void send(httplib::Response& response, std::string bytes, const std::string& type) {
  if (bytes.empty()) return response.set_content(bytes, type);
  const auto kept = std::make_shared<const std::string>(std::move(bytes));
  response.set_content_provider(kept->size(), type, [kept](std::size_t at, std::size_t count, httplib::DataSink& sink) {
    return sink.write(kept->data() + at, count);
  });
}

}  // namespace

struct ViewerServer::Parts {
  fs::path folder;
  int port = 0;
  httplib::Server server;

  void answer(const httplib::Request& request, httplib::Response& response) const {
    const std::string path = request.path == "/" ? std::string("/") + page : request.path;
    if (path == std::string("/") + asset_list_name)
      return send(response, asset_list_text(list_assets(folder)), media_type(path));
    const auto files = viewer_files();
    const auto own = std::ranges::find(files, std::string_view(path).substr(1), &ViewerFile::path);
    if (own != files.end()) return send(response, std::string(own->bytes), media_type(path));
    if (const auto file = served_file(folder, path)) return send(response, read_text(*file), media_type(path));
    tell(response, not_found, "no such file");
  }
};

ViewerServer::ViewerServer(fs::path folder, int port) : parts_(std::make_unique<Parts>()) {
  list_assets(folder);
  parts_->folder = std::move(folder);
  httplib::Server& server = parts_->server;

  // One server per port: the library's own options would let a second one share it.
  server.set_socket_options([](socket_t socket) {
    const int yes = 1;
    setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  });
  server.set_tcp_nodelay(true);
  constexpr int kept_requests = 1000, kept_seconds = 1;
  server.set_keep_alive_max_count(kept_requests);
  server.set_keep_alive_timeout(kept_seconds);
  server.set_payload_max_length(0);
  server.set_default_headers({{"X-Content-Type-Options", "nosniff"},
                              {"Content-Security-Policy", content_policy},
                              {"Cross-Origin-Resource-Policy", "same-origin"},
                              {"Referrer-Policy", "no-referrer"},
                              {"Cache-Control", "no-cache"}});
  server.set_pre_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
    using enum httplib::Server::HandlerResponse;
    if (!is_own_host(request.get_header_value("Host"), parts_->port)) {
      tell(response, forbidden, "this server answers to localhost alone");
      return Handled;
    }
    if (request.method != "GET" && request.method != "HEAD") {
      response.set_header("Allow", "GET, HEAD");
      tell(response, wrong_method, "this server is read only");
      return Handled;
    }
    return Unhandled;
  });
  server.Get(".*", [this](const httplib::Request& request, httplib::Response& response) {
    try {
      parts_->answer(request, response);
    } catch (const std::exception& error) {
      tell(response, not_found, error.what());
    }
  });

  const bool is_bound = port == 0 ? (parts_->port = server.bind_to_any_port(loopback)) > 0
                                  : server.bind_to_port(loopback, parts_->port = port);
  if (!is_bound)
    throw MachineLacks(
        fmt::format("port {} of {} cannot be used; another program may have it, or it is kept for the "
                    "system: name another with --port, or 0 for a free one",
                    port, loopback));
}

ViewerServer::~ViewerServer() = default;

int ViewerServer::port() const { return parts_->port; }

std::string ViewerServer::address() const { return fmt::format("http://{}:{}/", loopback, port()); }

void ViewerServer::run() {
  constexpr std::chrono::milliseconds glance(20);
  httplib::Server& server = parts_->server;
  std::atomic<bool> has_ended = false;
  std::thread answers([&] {
    server.listen_after_bind();
    has_ended = true;
  });
  while (!has_ended && (noted_signal() == 0 || !server.is_running())) std::this_thread::sleep_for(glance);
  if (!has_ended) server.stop();
  answers.join();
  throw_if_interrupted();
  throw std::runtime_error("the server stopped by itself");
}

}  // namespace kiln
