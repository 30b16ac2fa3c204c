// SPDX-License-Identifier: GPL-3.0-or-later
#include "kiln/page_frame.h"

#include <fmt/format.h>

namespace kiln {

namespace {

// Style sheet of all pages, in the colours of the reports.
constexpr const char* shared_style = R"css(
:root { color-scheme: light; --ink: #1d1c22; --soft: #65616e; --line: #dedbe2; --paper: #fbfaf8; --card: #fff;
  --good: #2f6b4f; --bad: #a8322a; --accent: #8a4b2a; }
* { box-sizing: border-box; }
body { margin: 0; background: var(--paper); color: var(--ink); font: 15px/1.5 system-ui, sans-serif; }
main { max-width: 1180px; margin: 0 auto; padding: 32px 24px 48px; }
h1 { margin: 0; font-size: 28px; letter-spacing: -0.01em; }
h2 { margin: 40px 0 4px; font-size: 20px; overflow-wrap: anywhere; }
.summary, .note, footer { color: var(--soft); }
.good { color: var(--good); font-weight: 600; } .bad { color: var(--bad); font-weight: 600; }
figure { margin: 0; background: var(--card); border: 1px solid var(--line); border-radius: 8px; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; width: 100%; font-size: 14px; }
th, td { padding: 5px 14px 5px 0; border-bottom: 1px solid var(--line); text-align: left; }
th { color: var(--soft); font-weight: 600; }
.number { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
footer { margin-top: 40px; font-size: 13px; }
@media (max-width: 760px) { main { padding: 20px 14px 32px; } }
)css";

}  // namespace

std::string framed(const Page& page) {
  return fmt::format(
      "<!doctype html>\n<html lang=en>\n<meta charset=utf-8>\n"
      "<meta name=viewport content='width=device-width, initial-scale=1'>\n<title>{} – Kiln</title>\n"
      "<style>{}{}</style>\n<main>\n<h1>{}</h1>\n<p class=summary>{}</p>\n{}<footer>Kiln {}</footer>\n</main>\n"
      "</html>\n",
      page.title, shared_style, page.style, page.heading, page.summary, page.content, KILN_VERSION);
}

}  // namespace kiln
