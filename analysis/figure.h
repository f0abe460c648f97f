// What all figures share: palette, fonts, and one gnuplot body drawn as SVG, PDF and PNG.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace parafovea {

struct FigureStyle {
    const char* colour;  // Okabe and Ito 2008: distinct to colour-blind readers
    int point;           // gnuplot point type; the shapes alone tell the series apart in grey print
};

// Of the n-th series; repeats after eight.
FigureStyle series_style(std::size_t n);

struct FigureSize {
    double width_cm = 17.0;
    double height_cm = 9.5;
};

// A gnuplot script that draws the body (settings and a plot command) three times: stem.svg, stem.pdf,
// stem.png.
std::string figure_script(const std::filesystem::path& stem, const FigureSize& size, const std::string& body);

// The three files figure_script makes.
std::vector<std::filesystem::path> figure_files(const std::filesystem::path& stem);

// A gnuplot SVG as an element of an HTML page: no prologue, ids that do not clash with other figures
// (prefix), a role and an alternative text.
std::string inline_svg(const std::filesystem::path& svg, const std::string& prefix,
                       const std::string& alternative_text);

}  // namespace parafovea
