// Prints the tables of docs/numerics.md as Markdown, each row with its bound and whether it holds.
// Usage: renderer_numerics [points per row, default 2000]
#include <cstdio>
#include <cstdlib>

#include "tests/renderer/numerics_rows.h"

namespace parafovea {
namespace {

bool print(const NumericsTable& table) {
    std::printf("\n## %s\n\n%s\n\n|", table.title.c_str(), table.text.c_str());
    for (const std::string& column : table.columns) std::printf(" %s |", column.c_str());
    std::printf(" |\n|");
    for (std::size_t i = 0; i <= table.columns.size(); ++i) std::printf("---|");
    std::printf("\n");
    bool all = true;
    for (const NumericsRow& row : table.rows) {
        std::printf("| %s |", row.what.c_str());
        for (const std::string& value : row.values) std::printf(" %s |", value.c_str());
        std::printf(" %s |\n", row.bound < 0 ? "" : row.within() ? "within" : "**BEYOND**");
        all = all && row.within();
    }
    return all;
}

}  // namespace
}  // namespace parafovea

int main(int argc, char** argv) {
    const int points = argc > 1 ? std::atoi(argv[1]) : 2000;
    if (points < 1) {
        std::fprintf(stderr, "usage: renderer_numerics [points per row]\n");
        return 2;
    }
    bool all = true;
    for (const parafovea::NumericsTable& table :
         {parafovea::round_trip_table(points), parafovea::worst_device_table(points),
          parafovea::texel_table(points), parafovea::axis_maps_table(points),
          parafovea::special_places_table(), parafovea::half_precision_table()})
        all = parafovea::print(table) && all;
    const parafovea::RandomMapCount random = parafovea::random_maps(10'000, 20);
    std::printf(
        "\n## Random configurations\n\n%d random settings, screens of 1 to 16384 pixels a side and gazes "
        "(inside, outside, on "
        "pixel centres, in corners, 10^6 pixels away, not a number, infinite), 20 places each, there and "
        "back: %d results that "
        "are no number or outside the buffer on this processor, %d on the worst legal device.\n",
        random.configurations, random.bad_here, random.bad_on_worst);
    if (!random.first_bad.empty()) std::printf("First: %s\n", random.first_bad.c_str());
    return all && random.bad_here + random.bad_on_worst == 0 ? 0 : 1;
}
