// Checks a folder against the rules of BIDS 1.11 that a data set of this kind must keep.
#include "analysis/bids_check.h"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <regex>
#include <set>
#include <sstream>
#include <stdexcept>

#include "analysis/gzip_file.h"

namespace parafovea {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using Row = std::vector<std::string>;

std::string read_text(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

std::vector<Row> split_table(const std::string& text) {
    std::vector<Row> rows;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        if (!line.empty() && line.back() == '\r') line.pop_back();
        rows.emplace_back();
        std::size_t at = 0;
        for (;;) {
            const std::size_t end = line.find('\t', at);
            rows.back().push_back(line.substr(at, end == std::string::npos ? end : end - at));
            if (end == std::string::npos) break;
            at = end + 1;
        }
    }
    return rows;
}

std::optional<double> as_number(const std::string& text) {
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return value;
}

// /a/b_physio.tsv.gz -> /a/b_physio.json
fs::path sidecar_of(const fs::path& data) {
    std::string name = data.filename().string();
    name = name.substr(0, name.find('.'));
    return data.parent_path() / (name + ".json");
}

class Checker {
  public:
    explicit Checker(const fs::path& root) : root_(root) {}

    std::vector<BidsViolation> run() {
        check_description();
        check_participants();
        check_phenotype();
        std::vector<fs::path> files;
        for (const auto& entry : fs::recursive_directory_iterator(root_))
            if (entry.is_regular_file()) files.push_back(entry.path());
        std::sort(files.begin(), files.end());
        for (const fs::path& file : files) check_file(file);
        return std::move(found_);
    }

  private:
    void add(const char* rule, const fs::path& file, const std::string& text) {
        found_.push_back({rule, fs::relative(file, root_), text});
    }

    // The object in a JSON file; absent, and reported, when there is none.
    std::optional<Json> object_in(const fs::path& path) {
        Json json = Json::parse(read_text(path), nullptr, false);
        if (json.is_discarded() || !json.is_object()) {
            add("json", path, "is not a JSON object");
            return std::nullopt;
        }
        return json;
    }

    std::optional<Json> sidecar(const fs::path& data) {
        const fs::path path = sidecar_of(data);
        if (!fs::exists(path)) {
            add("sidecar", data, "has no " + path.filename().string() + " beside it");
            return std::nullopt;
        }
        return object_in(path);
    }

    // Rows with a header, all of one width and without empty cells; what breaks that is reported.
    std::vector<Row> headed_table(const fs::path& path) {
        std::vector<Row> rows = split_table(read_text(path));
        check_cells(path, rows, rows.empty() ? 0 : rows[0].size());
        return rows;
    }

    void check_cells(const fs::path& path, const std::vector<Row>& rows, std::size_t width) {
        for (std::size_t i = 0; i < rows.size(); ++i) {
            if (rows[i].size() != width)
                return add("cells", path,
                           "line " + std::to_string(i + 1) + " has " + std::to_string(rows[i].size()) +
                               " cells; expected " + std::to_string(width));
            if (std::find(rows[i].begin(), rows[i].end(), "") != rows[i].end())
                return add("cells", path,
                           "line " + std::to_string(i + 1) + " has an empty cell; expected n/a");
        }
    }

    void require(const char* rule, const fs::path& file, const Json& json,
                 std::initializer_list<const char*> keys) {
        for (const char* key : keys)
            if (!json.contains(key)) add(rule, file, std::string("lacks ") + key);
    }

    void check_description() {
        const fs::path path = root_ / "dataset_description.json";
        if (!fs::exists(path)) return add("dataset_description", path, "is missing");
        const auto json = object_in(path);
        if (!json) return;
        require("dataset_description", path, *json, {"Name", "BIDSVersion"});
        if (!fs::exists(root_ / "README") && !fs::exists(root_ / "README.md"))
            add("dataset_description", root_ / "README.md", "is missing");
    }

    void check_participants() {
        const fs::path path = root_ / "participants.tsv";
        std::set<std::string> folders;
        for (const auto& entry : fs::directory_iterator(root_))
            if (entry.is_directory() && entry.path().filename().string().starts_with("sub-"))
                folders.insert(entry.path().filename().string());
        if (!fs::exists(path)) return add("participants", path, "is missing");
        const auto rows = headed_table(path);
        if (rows.empty() || rows[0][0] != "participant_id")
            return add("participants", path, "must begin with the column participant_id");
        static const std::regex kLabel("sub-[0-9A-Za-z]+");
        for (std::size_t i = 1; i < rows.size(); ++i) {
            if (!std::regex_match(rows[i][0], kLabel))
                add("participants", path, "'" + rows[i][0] + "' is not sub- and letters or digits");
            if (!participants_.insert(rows[i][0]).second)
                add("participants", path, "'" + rows[i][0] + "' stands there twice");
        }
        for (const std::string& folder : folders)
            if (!participants_.contains(folder))
                add("participants", path, "lacks " + folder + ", which has a folder");
    }

    void check_phenotype() {
        const fs::path folder = root_ / "phenotype";
        if (!fs::is_directory(folder)) return;
        for (const auto& entry : fs::directory_iterator(folder)) {
            if (entry.path().extension() != ".tsv") continue;
            const auto rows = headed_table(entry.path());
            if (rows.empty() || rows[0][0] != "participant_id") {
                add("phenotype", entry.path(), "must begin with the column participant_id");
                continue;
            }
            sidecar(entry.path());
            for (std::size_t i = 1; i < rows.size(); ++i)
                if (!participants_.contains(rows[i][0]))
                    add("phenotype", entry.path(), rows[i][0] + " is not in participants.tsv");
        }
    }

    void check_file(const fs::path& path) {
        const std::string relative = fs::relative(path, root_).generic_string();
        if (relative.find('/') == std::string::npos || relative.starts_with("phenotype/") ||
            relative.starts_with("stimuli/"))
            return;
        const std::string name = path.filename().string();
        // Entities in their order, a suffix that is known, and an ending.
        static const std::regex kName(
            "(sub-[0-9A-Za-z]+)(_ses-[0-9A-Za-z]+)?(_task-[0-9A-Za-z]+)?(_tracksys-[0-9A-Za-z]+)?(_acq-[0-9A-"
            "Za-z]+)?"
            "(_run-[0-9]+)?(_recording-[0-9A-Za-z]+)?_([a-z]+)\\.(tsv|json|tsv\\.gz)");
        std::smatch part;
        if (!std::regex_match(name, part, kName))
            return add("file_name", path, "has a name that BIDS does not know");
        const std::string suffix = part[8], ending = part[9];
        static const std::set<std::string> kSuffixes{"events", "beh",      "physio", "physioevents",
                                                     "motion", "channels", "scans"};
        if (!kSuffixes.contains(suffix))
            return add("file_name", path, "has the unknown suffix '" + suffix + "'");
        const bool compressed = suffix == "physio" || suffix == "physioevents";
        if (ending != "json" && (ending == "tsv.gz") != compressed)
            return add("file_name", path,
                       compressed ? "must be compressed (.tsv.gz)" : "must not be compressed");
        if (suffix != "scans" && !part[3].matched) add("file_name", path, "lacks its task");
        if ((suffix == "motion" || suffix == "channels") && !part[4].matched)
            add("file_name", path, "lacks its tracksys");

        // The folders repeat the subject and the session, and name the kind of data.
        std::string expected = part[1].str() + "/";
        if (part[2].matched) expected += part[2].str().substr(1) + "/";
        if (suffix == "motion" || suffix == "channels")
            expected += "motion/";
        else if (suffix != "scans")
            expected += "beh/";
        if (relative != expected + name) add("folder", path, "must lie in " + expected);

        if (ending == "json") return;
        if (suffix == "events") check_events(path);
        if (suffix == "physio") check_physio(path);
        if (suffix == "physioevents") check_physio_events(path);
        if (suffix == "motion") check_motion(path);
        if (suffix == "scans") check_scans(path);
        if (suffix == "beh") {
            headed_table(path);
            sidecar(path);
        }
    }

    void check_events(const fs::path& path) {
        sidecar(path);
        const auto rows = headed_table(path);
        if (rows.empty() || rows[0].size() < 2 || rows[0][0] != "onset" || rows[0][1] != "duration")
            return add("events_columns", path, "must begin with the columns onset and duration");
        double last = -1e300;
        for (std::size_t i = 1; i < rows.size(); ++i) {
            const auto onset = rows[i].empty() ? std::nullopt : as_number(rows[i][0]);
            if (!onset || rows[i].size() < 2 || (rows[i][1] != "n/a" && !as_number(rows[i][1])))
                return add(
                    "events_columns", path,
                    "line " + std::to_string(i + 1) + ": onset must be a number, duration a number or n/a");
            if (*onset < last)
                return add("events_order", path,
                           "line " + std::to_string(i + 1) + " begins before the line above it");
            last = *onset;
        }
        const std::string stem =
            path.filename().string().substr(0, path.filename().string().rfind("_events"));
        for (const auto& entry : fs::directory_iterator(path.parent_path())) {
            const std::string other = entry.path().filename().string();
            if (other.starts_with(stem) && other.ends_with("_physio.tsv.gz")) return;
        }
        add("events_alone", path, "stands beside no recording; without one use _beh.tsv");
    }

    std::optional<std::vector<Row>> compressed_rows(const fs::path& path) {
        try {
            return split_table(read_gzip_file(path));
        } catch (const std::runtime_error& error) {
            add("gzip", path, error.what());
            return std::nullopt;
        }
    }

    std::vector<std::string> columns_of(const Json& json) {
        std::vector<std::string> columns;
        if (json.contains("Columns") && json["Columns"].is_array())
            for (const Json& column : json["Columns"])
                if (column.is_string()) columns.push_back(column.get<std::string>());
        return columns;
    }

    // Numbers or n/a under the columns that the sidecar names, and no header line.
    void check_headless(const char* rule, const fs::path& path, const std::vector<std::string>& columns) {
        const auto rows = compressed_rows(path);
        if (!rows || rows->empty()) return;
        check_cells(path, *rows, columns.size());
        if (!as_number(rows->front()[0]))
            add(rule, path, "has a header line; the columns belong into the JSON file");
    }

    void check_physio(const fs::path& path) {
        const auto json = sidecar(path);
        if (!json) return;
        const fs::path about = sidecar_of(path);
        require("physio_columns", about, *json, {"SamplingFrequency", "StartTime", "Columns", "PhysioType"});
        const auto columns = columns_of(*json);
        if (columns.size() < 3 || columns[0] != "timestamp" || columns[1] != "x_coordinate" ||
            columns[2] != "y_coordinate")
            add("physio_columns", about, "Columns must begin with timestamp, x_coordinate, y_coordinate");
        if (json->value("PhysioType", Json()) != "eyetrack")
            add("physio_columns", about, "PhysioType must be eyetrack");
        const Json eye = json->value("RecordedEye", Json());
        if (eye != "left" && eye != "right" && eye != "cyclopean")
            add("physio_eye", about, "RecordedEye must be left, right or cyclopean");
        const std::string name = path.filename().string();
        if (name.find("_recording-eye1_") == std::string::npos &&
            name.find("_recording-eye2_") == std::string::npos &&
            name.find("_recording-eye3_") == std::string::npos)
            add("physio_eye", path, "must be named recording-eye1, -eye2 or -eye3");
        const Json system = json->value("SampleCoordinateSystem", Json());
        if (system != "gaze-on-screen" && system != "eye-in-head" && system != "gaze-in-world" &&
            system != "custom")
            add("physio_coordinates", about,
                "SampleCoordinateSystem must be gaze-on-screen, eye-in-head, gaze-in-world or custom");
        if (system == "gaze-on-screen") {
            const Json screen = json->value("StimulusPresentation", Json::object());
            for (const char* key : {"ScreenDistance", "ScreenOrigin", "ScreenResolution", "ScreenSize"})
                if (!screen.contains(key))
                    add("physio_coordinates", about,
                        std::string("gaze on a screen needs StimulusPresentation.") + key);
        }
        for (const char* axis : {"x_coordinate", "y_coordinate"})
            if (!json->contains(axis) || !(*json)[axis].is_object() || !(*json)[axis].contains("Units"))
                add("physio_units", about, std::string(axis) + " lacks its Units");
        if (std::find(columns.begin(), columns.end(), "pupil_size") != columns.end()) {
            const Json pupil = json->value("pupil_size", Json::object());
            const std::string text =
                pupil.is_object() ? pupil.value("Description", std::string()) : std::string();
            if (text.find("area") == std::string::npos && text.find("diameter") == std::string::npos)
                add("physio_pupil", about, "the Description of pupil_size must say area or diameter");
        }
        if (json->contains("CalibrationUnit") && (*json)["CalibrationUnit"] != "pixel" &&
            (*json)["CalibrationUnit"] != "mm" && (*json)["CalibrationUnit"] != "cm")
            add("physio_calibration", about, "CalibrationUnit must be pixel, mm or cm");
        if (!columns.empty()) check_headless("physio_columns", path, columns);
    }

    void check_physio_events(const fs::path& path) {
        const auto json = sidecar(path);
        if (!json) return;
        const fs::path about = sidecar_of(path);
        const auto columns = columns_of(*json);
        if (columns.empty() || columns[0] != "onset")
            add("physioevents_columns", about, "Columns must begin with onset");
        else
            check_headless("physioevents_columns", path, columns);
        // The onset is in units of a column of the recording that these events belong to.
        std::string name = path.filename().string();
        name = name.substr(0, name.rfind("_physioevents")) + "_physio.json";
        const fs::path recording = path.parent_path() / name;
        if (!fs::exists(recording)) return add("physioevents_source", path, "stands beside no " + name);
        const Json physio = Json::parse(read_text(recording), nullptr, false);
        const auto samples = physio.is_object() ? columns_of(physio) : std::vector<std::string>();
        const Json source = json->value("OnsetSource", Json());
        if (!source.is_string() ||
            std::find(samples.begin(), samples.end(), source.get<std::string>()) == samples.end())
            add("physioevents_source", about,
                "OnsetSource must be a column of the recording, such as timestamp");
    }

    void check_motion(const fs::path& path) {
        if (const auto json = sidecar(path))
            require("motion_sidecar", sidecar_of(path), *json, {"SamplingFrequency", "TaskName"});
        std::string name = path.filename().string();
        const fs::path channels =
            path.parent_path() / (name.substr(0, name.rfind("_motion")) + "_channels.tsv");
        if (!fs::exists(channels))
            return add("motion_channels", path, "has no " + channels.filename().string() + " beside it");
        const auto rows = headed_table(channels);
        const Row expected{"name", "component", "type", "tracked_point", "units"};
        if (rows.empty() || rows[0].size() < 5 ||
            !std::equal(expected.begin(), expected.end(), rows[0].begin()))
            return add("motion_channels", channels,
                       "must begin with name, component, type, tracked_point, units");
        static const std::set<std::string> kTypes{"ACCEL", "ANGACCEL", "GYRO", "JNTANG", "LATENCY",
                                                  "MAGN",  "MISC",     "ORNT", "POS",    "VEL"};
        static const std::set<std::string> kComponents{"x",      "y",      "z",      "quat_x",
                                                       "quat_y", "quat_z", "quat_w", "n/a"};
        for (std::size_t i = 1; i < rows.size(); ++i) {
            if (rows[i].size() < 3) continue;
            if (!kTypes.contains(rows[i][2]))
                add("motion_channels", channels, "'" + rows[i][2] + "' is no type of channel");
            if (!kComponents.contains(rows[i][1]))
                add("motion_channels", channels, "'" + rows[i][1] + "' is no component");
        }
        const auto samples = split_table(read_text(path));
        if (samples.empty()) return;
        check_cells(path, samples, rows.size() - 1);
        if (!as_number(samples[0][0]))
            add("motion_channels", path, "has a header line; the columns are the rows of the channels file");
    }

    void check_scans(const fs::path& path) {
        const auto rows = headed_table(path);
        if (rows.empty() || rows[0][0] != "filename")
            return add("scans", path, "must begin with the column filename");
        for (std::size_t i = 1; i < rows.size(); ++i)
            if (!fs::exists(path.parent_path() / rows[i][0]))
                add("scans", path, rows[i][0] + " is not there");
    }

    fs::path root_;
    std::set<std::string> participants_;
    std::vector<BidsViolation> found_;
};

}  // namespace

std::vector<BidsViolation> check_bids(const std::filesystem::path& folder) {
    if (!fs::is_directory(folder))
        throw std::runtime_error(folder.string() + ": is not a folder; expected a BIDS data set");
    return Checker(folder).run();
}

}  // namespace parafovea
