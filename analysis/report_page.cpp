// The frame of report.html: head, style and headings; self-contained and readable by assistive software.
#include "analysis/report_page.h"

#include "analysis/html_text.h"

namespace parafovea {
namespace {

constexpr const char* kStyle = R"(
:root { --ink: #1b1b1b; --soft: #555; --line: #cfcfcf; --shade: #f4f4f2; --mark: #0b5394; }
* { box-sizing: border-box; }
html { font: 16px/1.5 "DejaVu Sans", "Helvetica Neue", Arial, sans-serif; color: var(--ink); background: #fff; }
body { max-width: 62rem; margin: 0 auto; padding: 1.5rem 1.25rem 4rem; }
h1 { font-size: 1.6rem; line-height: 1.25; margin: 0 0 .25rem; }
h2 { font-size: 1.2rem; margin: 2.2rem 0 .6rem; padding-top: .6rem; border-top: 1px solid var(--line); }
h3 { font-size: 1rem; margin: 1.4rem 0 .4rem; }
p, li { max-width: 46rem; }
a { color: var(--mark); }
a:focus-visible, summary:focus-visible, .scroll:focus-visible { outline: 3px solid #e69f00; outline-offset: 2px; }
.skip { position: absolute; left: -999rem; }
.skip:focus { position: static; }
.banner { border: 2px solid #8a4b00; background: #fff4e0; padding: .6rem .9rem; margin: 1rem 0; font-weight: 600; }
.warning { border-left: 4px solid #d55e00; background: #fdf3ee; padding: .5rem .9rem; margin: .6rem 0; }
.note { color: var(--soft); font-size: .9rem; }
nav ul { columns: 2; padding-left: 1.2rem; margin: .5rem 0; }
figure { margin: 1rem 0; }
figure svg { width: 100%; height: auto; display: block; }
figcaption, caption { text-align: left; color: var(--soft); font-size: .9rem; padding: .3rem 0; max-width: 46rem; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; font-size: .86rem; font-variant-numeric: tabular-nums; margin: .6rem 0; }
th, td { padding: .22rem .7rem .22rem 0; text-align: left; vertical-align: bottom; border-bottom: 1px solid #e6e6e6; }
thead th { border-bottom: 2px solid var(--ink); }
.number { text-align: right; }
details > summary { cursor: pointer; margin: .6rem 0; }
@media print {
  html { font-size: 10pt; }
  body { max-width: none; padding: 0; }
  nav, .skip { display: none; }
  h2 { break-after: avoid; }
  figure, tr, .warning, .banner { break-inside: avoid; }
  .scroll { overflow: visible; }
}
)";

}  // namespace

std::string html_table(const std::string& caption, const std::vector<std::vector<std::string>>& rows,
                       std::size_t numeric_from) {
    if (rows.empty()) return {};
    std::string html = "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"" +
                       html_escaped(caption) + "\"><table><caption>" + html_escaped(caption) +
                       "</caption>\n<thead><tr>";
    for (std::size_t i = 0; i < rows[0].size(); ++i)
        html += std::string("<th scope=\"col\"") + (i >= numeric_from ? " class=\"number\">" : ">") +
                html_escaped(rows[0][i]) + "</th>";
    html += "</tr></thead>\n<tbody>\n";
    for (std::size_t r = 1; r < rows.size(); ++r) {
        html += "<tr>";
        for (std::size_t i = 0; i < rows[r].size(); ++i) {
            const std::string kind = i == 0 ? "th scope=\"row\"" : "td";
            html += "<" + kind + (i >= numeric_from ? " class=\"number\">" : ">") + html_escaped(rows[r][i]) +
                    (i == 0 ? "</th>" : "</td>");
        }
        html += "</tr>\n";
    }
    return html + "</tbody></table></div>\n";
}

std::string html_paragraph(const std::string& plain_text) {
    return "<p>" + html_escaped(plain_text) + "</p>\n";
}

std::string html_page(const std::string& title, const std::string& banner,
                      const std::vector<ReportSection>& sections) {
    std::string html =
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
        html_escaped(title) + "</title>\n<link rel=\"icon\" href=\"data:,\">\n<style>" + kStyle +
        "</style>\n</head>\n<body>\n<a class=\"skip\" href=\"#content\">Skip to the "
        "results</a>\n<header>\n<h1>" +
        html_escaped(title) + "</h1>\n";
    if (!banner.empty()) html += "<div class=\"banner\" role=\"note\">" + html_escaped(banner) + "</div>\n";
    html += "</header>\n<nav aria-label=\"Contents\"><ul>\n";
    for (const ReportSection& section : sections)
        html += "<li><a href=\"#" + section.id + "\">" + html_escaped(section.heading) + "</a></li>\n";
    html += "</ul></nav>\n<main id=\"content\" tabindex=\"-1\">\n";
    for (const ReportSection& section : sections)
        html += "<section aria-labelledby=\"" + section.id + "\">\n<h2 id=\"" + section.id + "\">" +
                html_escaped(section.heading) + "</h2>\n" + section.html + "</section>\n";
    return html + "</main>\n</body>\n</html>\n";
}

}  // namespace parafovea
