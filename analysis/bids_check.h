// Checks a folder against the rules of BIDS 1.11 that a data set of this kind must keep.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace parafovea {

struct BidsViolation {
    std::string rule;            // a short name, the same for every file
    std::filesystem::path file;  // relative to the data set
    std::string text;            // what is wrong, and what was expected
};

// Rules: dataset_description, participants, phenotype, file_name, folder, sidecar, events_columns,
// events_order, events_alone, physio_columns, physio_eye, physio_coordinates, physio_units, physio_pupil,
// physio_calibration, physioevents_columns, physioevents_source, motion_channels, motion_sidecar, scans,
// cells, json, gzip. An empty list: no violation. Throws std::runtime_error when the folder is not there.
std::vector<BidsViolation> check_bids(const std::filesystem::path& folder);

}  // namespace parafovea
