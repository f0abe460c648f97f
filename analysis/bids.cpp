// Writes a study as a BIDS 1.11 data set: events, eye tracking, motion, participants and questionnaires.
#include "analysis/bids.h"

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "analysis/gzip_file.h"
#include "analysis/number_text.h"
#include "analysis/text_file.h"

namespace parafovea {
namespace {

using Json = nlohmann::ordered_json;

std::string json_text(const Json& json) {
    return json.dump(2, ' ', false, nlohmann::detail::error_handler_t::replace) + "\n";
}

// A cell of a TSV: never empty, never with a tab or a line end.
std::string cell(const std::string& text) {
    if (text.empty()) return "n/a";
    std::string clean = text;
    std::replace_if(
        clean.begin(), clean.end(), [](char c) { return c == '\t' || c == '\n' || c == '\r'; }, ' ');
    return clean;
}

std::string cell(const std::optional<double>& value, int digits) {
    return value ? fixed_text(*value, digits) : "n/a";
}

std::string two_digits(int number) {
    return (number < 10 ? "0" : "") + std::to_string(number);
}

Json column_json(const BidsColumn& column) {
    Json json{{"Description", column.description}};
    if (!column.units.empty()) json["Units"] = column.units;
    return json;
}

const char* eye_entity(BidsEye eye) {
    return eye == BidsEye::left ? "eye1" : eye == BidsEye::right ? "eye2" : "eye3";
}
const char* eye_name(BidsEye eye) {
    return eye == BidsEye::left ? "left" : eye == BidsEye::right ? "right" : "cyclopean";
}

void add_screen(Json& json, const BidsRun& run) {
    if (run.screen_distance_m) json["ScreenDistance"] = *run.screen_distance_m;
    if (run.screen_refresh_hz) json["ScreenRefreshRate"] = *run.screen_refresh_hz;
    if (run.screen_resolution_px)
        json["ScreenResolution"] = {run.screen_resolution_px->first, run.screen_resolution_px->second};
    if (run.screen_size_m) json["ScreenSize"] = {run.screen_size_m->first, run.screen_size_m->second};
}

}  // namespace

std::string bids_label(const std::string& identifier) {
    std::string label;
    for (char c : identifier)
        if ((c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z')) label += c;
    return label;
}

void BidsWriter::put(const std::filesystem::path& path, const std::string& text) {
    make_output_folder(path.parent_path());
    write_text_file(path, text);
    written_.push_back(path);
}

void BidsWriter::put_compressed(const std::filesystem::path& path, const std::string& text) {
    make_output_folder(path.parent_path());
    write_gzip_file(path, text);
    written_.push_back(path);
}

BidsWriter::BidsWriter(const std::filesystem::path& folder, const BidsDataset& dataset)
    : folder_(folder), dataset_(dataset) {
    for (const BidsParticipant& participant : dataset.participants) {
        const std::string label = bids_label(participant.id);
        if (label.empty() || !labels_.insert(label).second)
            throw std::runtime_error("BIDS: participant '" + participant.id +
                                     "' has no label of its own: only letters and digits count");
        if (participant.values.size() != dataset.participant_columns.size())
            throw std::runtime_error("BIDS: participant '" + participant.id + "' has " +
                                     std::to_string(participant.values.size()) + " values for " +
                                     std::to_string(dataset.participant_columns.size()) + " columns");
    }

    Json description{{"Name", dataset.name}, {"BIDSVersion", "1.11.1"}, {"DatasetType", "raw"}};
    if (dataset.license != "n/a" && !dataset.license.empty()) description["License"] = dataset.license;
    if (!dataset.authors.empty()) description["Authors"] = dataset.authors;
    description["GeneratedBy"] =
        Json::array({Json{{"Name", dataset.software_name}, {"Version", dataset.software_version}}});
    put(folder_ / "dataset_description.json", json_text(description));
    std::string readme = "# " + dataset.name + "\n\n" + dataset.task_description + "\n";
    if (!dataset.data_origin.empty()) readme += "\nData: " + dataset.data_origin + ".\n";
    put(folder_ / "README.md", readme);

    // Participants, with what their columns mean.
    std::string table = "participant_id";
    Json columns{{"participant_id", {{"Description", "Label of the participant's folder"}}}};
    for (const BidsColumn& column : dataset.participant_columns) {
        table += "\t" + column.name;
        columns[column.name] = column_json(column);
    }
    table += "\n";
    for (const BidsParticipant& participant : dataset.participants) {
        table += "sub-" + bids_label(participant.id);
        for (const std::string& value : participant.values) table += "\t" + cell(value);
        table += "\n";
    }
    put(folder_ / "participants.tsv", table);
    put(folder_ / "participants.json", json_text(columns));

    for (const BidsQuestionnaire& questionnaire : dataset.questionnaires) {
        std::string answers = "participant_id";
        Json items{{"MeasurementToolMetadata", {{"Description", questionnaire.description}}}};
        items["participant_id"] = {{"Description", "Label of the participant's folder"}};
        for (const BidsColumn& item : questionnaire.items) {
            answers += "\t" + item.name;
            items[item.name] = column_json(item);
        }
        answers += "\n";
        for (const BidsParticipant& row : questionnaire.answers) {
            answers += "sub-" + bids_label(row.id);
            for (const std::string& value : row.values) answers += "\t" + cell(value);
            answers += "\n";
        }
        put(folder_ / "phenotype" / (questionnaire.name + ".tsv"), answers);
        put(folder_ / "phenotype" / (questionnaire.name + ".json"), json_text(items));
    }
}

void BidsWriter::write(const BidsRun& run) {
    const std::string label = bids_label(run.participant);
    const std::string who =
        "BIDS: participant '" + run.participant + "', session " + std::to_string(run.session);
    if (!labels_.contains(label))
        throw std::runtime_error(who + ": is not among the participants of the data set");
    const std::string subject = "sub-" + label, session = "ses-" + two_digits(run.session);
    const std::string prefix = subject + "_" + session, task = "_task-" + bids_label(dataset_.task);
    if (!runs_.insert(prefix + "_run-" + std::to_string(run.run)).second)
        throw std::runtime_error(who + ": run " + std::to_string(run.run) + " is there twice");
    const std::filesystem::path place = folder_ / subject / session;
    const std::filesystem::path stem = place / "beh" / (prefix + task + "_run-" + std::to_string(run.run));

    std::set<BidsEye> eyes;
    std::string scans;
    const std::string acquired = "\t" + cell(run.acquired) + "\n";
    for (const BidsGaze& gaze : run.gaze) {
        if (!eyes.insert(gaze.eye).second)
            throw std::runtime_error(who + ": two recordings of the " + eye_name(gaze.eye) + " eye");
        write_gaze(run, gaze, stem);
        scans += "beh/" + stem.filename().string() + "_recording-" + eye_entity(gaze.eye) + "_physio.tsv.gz" +
                 acquired;
    }
    // An events file must stand beside a recording; alone, the answers are behaviour and need no onset.
    write_events(run, stem);
    if (run.gaze.empty()) scans += "beh/" + stem.filename().string() + "_beh.tsv" + acquired;
    if (!run.motion.empty()) {
        const std::string name = prefix + task + "_tracksys-hmd_run-" + std::to_string(run.run);
        write_motion(run, place / "motion", name);
        scans += "motion/" + name + "_motion.tsv" + acquired;
    }

    // The scans file grows with every run of the session.
    const std::filesystem::path scans_file = place / (prefix + "_scans.tsv");
    if (scans_.insert(scans_file).second) {
        put(scans_file, "filename\tacq_time\n" + scans);
    } else {
        std::ofstream file(scans_file, std::ios::binary | std::ios::app);
        file << scans;
        file.close();
        if (!file) throw std::runtime_error(scans_file.string() + ": cannot be written; is the disk full?");
    }
}

void BidsWriter::write_events(const BidsRun& run, const std::filesystem::path& stem) {
    std::vector<const BidsEvent*> events;
    for (const BidsEvent& event : run.events) {
        if (event.values.size() != run.event_columns.size())
            throw std::runtime_error("BIDS: an event of participant '" + run.participant + "' has " +
                                     std::to_string(event.values.size()) + " values for " +
                                     std::to_string(run.event_columns.size()) + " columns");
        events.push_back(&event);
    }
    std::stable_sort(events.begin(), events.end(),
                     [](const BidsEvent* a, const BidsEvent* b) { return a->onset_s < b->onset_s; });

    const bool timed = !run.gaze.empty();
    std::string table = timed ? "onset\tduration\ttrial_type\tresponse_time" : "trial_type\tresponse_time";
    Json json;
    json["TaskName"] = dataset_.task;
    json["TaskDescription"] = dataset_.task_description;
    if (timed) {
        json["onset"] = {{"Description", "Start of the event from the start of the run"}, {"Units", "s"}};
        json["duration"] = {{"Description", "Length of the event"}, {"Units", "s"}};
    }
    json["trial_type"] = {{"Description", "What the event is"}};
    json["response_time"] = {{"Description", "From the question to the answer"}, {"Units", "s"}};
    for (const BidsColumn& column : run.event_columns) {
        table += "\t" + column.name;
        json[column.name] = column_json(column);
    }
    Json presentation{{"SoftwareName", dataset_.software_name},
                      {"SoftwareVersion", dataset_.software_version}};
    add_screen(presentation, run);
    json["StimulusPresentation"] = presentation;
    table += "\n";
    for (const BidsEvent* event : events) {
        if (timed) table += fixed_text(event->onset_s, 6) + "\t" + cell(event->duration_s, 6) + "\t";
        table += cell(event->trial_type) + "\t" + cell(event->response_time_s, 4);
        for (const std::string& value : event->values) table += "\t" + cell(value);
        table += "\n";
    }
    const std::string suffix = timed ? "_events" : "_beh";
    put(stem.string() + suffix + ".tsv", table);
    put(stem.string() + suffix + ".json", json_text(json));
}

void BidsWriter::write_gaze(const BidsRun& run, const BidsGaze& gaze, const std::filesystem::path& stem) {
    const std::string name = stem.string() + "_recording-" + eye_entity(gaze.eye);
    const bool pupil = std::any_of(gaze.samples.begin(), gaze.samples.end(),
                                   [](const auto& s) { return s.pupil.has_value(); });
    if (pupil && gaze.pupil_description.empty())
        throw std::runtime_error("BIDS: the pupil of participant '" + run.participant +
                                 "' needs a description that says area or diameter");

    Json json{{"SamplingFrequency", gaze.sampling_hz}, {"StartTime", gaze.start_time_s}};
    json["Columns"] = pupil ? Json{"timestamp", "x_coordinate", "y_coordinate", "pupil_size"}
                            : Json{"timestamp", "x_coordinate", "y_coordinate"};
    json["PhysioType"] = "eyetrack";
    json["RecordedEye"] = eye_name(gaze.eye);
    json["SampleCoordinateSystem"] = gaze.on_screen ? "gaze-on-screen" : "eye-in-head";
    json["timestamp"] = {{"Description", "Time from the start of the run, on the clock of the events"},
                         {"Units", "s"}};
    const std::string units = gaze.on_screen ? "pixel" : "degree";
    json["x_coordinate"] = {
        {"Description", gaze.on_screen ? "From the left edge" : "Azimuth, positive to the right"},
        {"Units", units}};
    json["y_coordinate"] = {
        {"Description", gaze.on_screen ? "From the top edge" : "Elevation, positive upwards"},
        {"Units", units}};
    if (pupil) json["pupil_size"] = {{"Description", gaze.pupil_description}, {"Units", "arbitrary"}};
    if (gaze.average_calibration_error_deg)
        json["AverageCalibrationError"] = *gaze.average_calibration_error_deg;
    if (gaze.maximal_calibration_error_deg)
        json["MaximalCalibrationError"] = *gaze.maximal_calibration_error_deg;
    if (!gaze.manufacturer.empty()) json["Manufacturer"] = gaze.manufacturer;
    if (!gaze.model.empty()) json["ManufacturersModelName"] = gaze.model;
    if (!gaze.software_version.empty()) json["SoftwareVersions"] = gaze.software_version;
    if (gaze.on_screen) {
        Json presentation = Json::object();
        add_screen(presentation, run);
        presentation["ScreenOrigin"] = {"top", "left"};
        json["StimulusPresentation"] = presentation;
    }
    std::string samples;
    samples.reserve(gaze.samples.size() * 32);
    for (const BidsGazeSample& sample : gaze.samples) {
        samples += fixed_text(sample.timestamp_s, 6) + "\t" + cell(sample.x, 4) + "\t" + cell(sample.y, 4);
        if (pupil) samples += "\t" + cell(sample.pupil, 4);
        samples += "\n";
    }
    put_compressed(name + "_physio.tsv.gz", samples);
    put(name + "_physio.json", json_text(json));
    if (gaze.events.empty()) return;

    std::vector<BidsGazeEvent> events = gaze.events;
    std::stable_sort(events.begin(), events.end(),
                     [](const auto& a, const auto& b) { return a.onset_s < b.onset_s; });
    std::string rows;
    for (const BidsGazeEvent& event : events)
        rows += fixed_text(event.onset_s, 6) + "\t" + cell(event.duration_s, 6) + "\t" +
                cell(event.trial_type) + "\t" + cell(event.message) + "\n";
    Json about{{"Columns", {"onset", "duration", "trial_type", "message"}}, {"OnsetSource", "timestamp"}};
    about["onset"] = {{"Description", "Start of the event, on the clock of the samples"}, {"Units", "s"}};
    about["duration"] = {{"Description", "Length of the event"}, {"Units", "s"}};
    about["trial_type"] = {{"Description", "Kind of eye movement or message"}};
    about["message"] = {{"Description", "What the program noted"}};
    put_compressed(name + "_physioevents.tsv.gz", rows);
    put(name + "_physioevents.json", json_text(about));
}

void BidsWriter::write_motion(const BidsRun& run, const std::filesystem::path& folder,
                              const std::string& prefix) {
    std::string rows;
    for (const BidsPose& pose : run.motion) {
        for (double value :
             {pose.x_m, pose.y_m, pose.z_m, pose.quat_x, pose.quat_y, pose.quat_z, pose.quat_w})
            rows += fixed_text(value, 6) + "\t";
        rows += fixed_text(pose.latency_s, 6) + "\n";
    }
    std::string channels = "name\tcomponent\ttype\ttracked_point\tunits\n";
    for (const char* axis : {"x", "y", "z"})
        channels += std::string("head_pos_") + axis + "\t" + axis + "\tPOS\thead\tm\n";
    for (const char* part : {"quat_x", "quat_y", "quat_z", "quat_w"})
        channels += std::string("head_") + part + "\t" + part + "\tORNT\thead\tn/a\n";
    channels += "latency\tn/a\tLATENCY\tn/a\ts\n";
    const Json json{{"SamplingFrequency", run.motion_hz},
                    {"TaskName", dataset_.task},
                    {"TaskDescription", dataset_.task_description},
                    {"TrackingSystemName", "hmd"},
                    {"MotionChannelCount", 8},
                    {"POSChannelCount", 3},
                    {"ORNTChannelCount", 4},
                    {"LATENCYChannelCount", 1}};
    put(folder / (prefix + "_motion.tsv"), rows);
    put(folder / (prefix + "_motion.json"), json_text(json));
    put(folder / (prefix + "_channels.tsv"), channels);
}

}  // namespace parafovea
