// What all figures share: palette, fonts, and one gnuplot body drawn as SVG, PDF and PNG.
#include "analysis/figure.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "analysis/html_text.h"
#include "analysis/number_text.h"

namespace parafovea {
namespace {

void replace_all(std::string& text, const std::string& from, const std::string& to) {
    for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
        text.replace(at, from.size(), to);
}

std::string path_quoted(const std::filesystem::path& path) {
    std::string quoted = "'";
    for (char c : path.string()) quoted += c == '\'' ? std::string("''") : std::string(1, c);
    return quoted + "'";
}

}  // namespace

FigureStyle series_style(std::size_t n) {
    static constexpr std::array<FigureStyle, 8> kStyles{{{"#D55E00", 7},
                                                         {"#E69F00", 5},
                                                         {"#009E73", 9},
                                                         {"#0072B2", 13},
                                                         {"#000000", 11},
                                                         {"#56B4E9", 15},
                                                         {"#CC79A7", 6},
                                                         {"#555555", 4}}};
    return kStyles[n % kStyles.size()];
}

std::string figure_script(const std::filesystem::path& stem, const FigureSize& size,
                          const std::string& body) {
    const std::string size_cm = fixed_text(size.width_cm, 2) + "cm," + fixed_text(size.height_cm, 2) + "cm";
    constexpr double kSvgUnitsPerCm =
        52.0;  // makes 13 units a readable letter on a screen; SVG scales anyway
    const std::string size_svg =
        fixed_text(size.width_cm * kSvgUnitsPerCm, 0) + "," + fixed_text(size.height_cm * kSvgUnitsPerCm, 0);
    std::string script = "set encoding utf8\n";
    const auto draw = [&](const std::string& terminal, const char* suffix) {
        std::filesystem::path file = stem;
        file += suffix;
        script +=
            "reset\n" + terminal + "\nset output " + path_quoted(file) + "\n" + body + "\nunset output\n";
    };
    draw("set terminal svg size " + size_svg +
             " fixed enhanced font 'DejaVu Sans,13' linewidth 1.2 background rgb 'white'",
         ".svg");
    draw("set terminal pdfcairo size " + size_cm +
             " enhanced font 'DejaVu Sans,8' linewidth 1.4 fontscale 1.0",
         ".pdf");
    // For screens and slides (print takes the PDF): 200 dpi, and no wider than a page's text of 6.5 inches;
    // letters, lines and points are of the same share of the picture in all figures of one width. Most of a
    // figure's time is the compression of these pixels.
    const double pixels_per_cm = 1300.0 / std::max(size.width_cm, 16.51);
    const auto scaled = [&](double at_118) { return fixed_text(at_118 * pixels_per_cm / 118.1, 3); };
    draw("set terminal pngcairo size " + fixed_text(size.width_cm * pixels_per_cm, 0) + "," +
             fixed_text(size.height_cm * pixels_per_cm, 0) + " enhanced font 'DejaVu Sans,12' fontscale " +
             scaled(2.067) + " linewidth " + scaled(2.854) + " pointscale " + scaled(2.362),
         ".png");
    return script;
}

std::vector<std::filesystem::path> figure_files(const std::filesystem::path& stem) {
    std::vector<std::filesystem::path> files;
    for (const char* suffix : {".svg", ".png", ".pdf"}) {
        files.push_back(stem);
        files.back() += suffix;
    }
    return files;
}

std::string inline_svg(const std::filesystem::path& svg, const std::string& prefix,
                       const std::string& alternative_text) {
    std::ifstream input(svg, std::ios::binary);
    if (!input) throw std::runtime_error(svg.string() + ": the figure just drawn cannot be read");
    std::string text{std::istreambuf_iterator<char>(input), std::istreambuf_iterator<char>()};
    const std::size_t start = text.find("<svg");
    if (start == std::string::npos) throw std::runtime_error(svg.string() + ": is not an SVG file");
    text.erase(0, start);
    replace_all(text, "id=\"", "id=\"" + prefix);
    replace_all(text, "id='", "id='" + prefix);
    replace_all(text, "href='#", "href='#" + prefix);
    replace_all(text, "href=\"#", "href=\"#" + prefix);
    replace_all(text, "url(#", "url(#" + prefix);
    // gnuplot names the figure after itself; a reader's software should hear what it shows.
    const std::size_t title = text.find("<title>"), title_end = text.find("</title>");
    if (title != std::string::npos && title_end != std::string::npos)
        text.erase(title, title_end + 8 - title);
    const std::size_t description = text.find("<desc>"), description_end = text.find("</desc>");
    if (description != std::string::npos && description_end != std::string::npos)
        text.erase(description, description_end + 7 - description);
    text.insert(4, " role=\"img\" aria-label=\"" + html_escaped(alternative_text) + "\"");
    return text;
}

}  // namespace parafovea
