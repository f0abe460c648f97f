// The extremes of the foveation maps, measured against long double: the rows of docs/numerics.md, which
// numerics_test.cpp holds to their bounds.
#pragma once

#include <string>
#include <vector>

namespace parafovea {

// One claim and what was measured. A row without a bound is there for comparison only.
struct NumericsRow {
    std::string what;
    std::vector<std::string> values;  // one for each column after the first
    double measured = 0;              // what the bound is about
    double bound = -1;                // below 0: none

    bool within() const { return bound < 0 || measured <= bound; }
};

struct NumericsTable {
    std::string title;
    std::string text;  // what is measured and how, in sentences
    std::vector<std::string> columns;
    std::vector<NumericsRow> rows;
};

// `points` per row, some of them near the gaze, on the axes and in the corners.
NumericsTable round_trip_table(int points);
NumericsTable texel_table(int points);
NumericsTable worst_device_table(int points);
NumericsTable special_places_table();
NumericsTable half_precision_table();
NumericsTable axis_maps_table(int points);

// Maps of random settings, screens and gazes, finite and not: how many results are no number or outside the
// buffer.
struct RandomMapCount {
    int configurations = 0;
    int bad_here = 0;       // computed by this processor
    int bad_on_worst = 0;   // on the worst legal device
    std::string first_bad;  // how the first bad one was configured
};
RandomMapCount random_maps(int configurations, int points);

}  // namespace parafovea
