// The frame of report.html: head, style and headings; self-contained and readable by assistive software.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace parafovea {

// A section of the report: a heading and its HTML.
struct ReportSection {
    std::string id;
    std::string heading;
    std::string html;
};

// A table whose first row is its head; every cell is plain text (escaped here). numeric: right-aligned from
// this column on.
std::string html_table(const std::string& caption, const std::vector<std::vector<std::string>>& rows,
                       std::size_t numeric_from = 0);

std::string html_paragraph(const std::string& plain_text);

// A page with a skip link, a list of contents and the sections. banner: shown on top and in print, empty for
// none.
std::string html_page(const std::string& title, const std::string& banner,
                      const std::vector<ReportSection>& sections);

}  // namespace parafovea
