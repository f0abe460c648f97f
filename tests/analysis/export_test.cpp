// Exports: a BIDS folder that keeps its rules, each rule's violation found, the long CSV and its way back.
#include <gtest/gtest.h>

#include <functional>
#include <nlohmann/json.hpp>

#include "analysis/bids.h"
#include "analysis/bids_check.h"
#include "analysis/gzip_file.h"
#include "analysis/long_csv.h"
#include "tests/message_of.h"
#include "tests/temporary_folder.h"

namespace parafovea {
namespace {

namespace fs = std::filesystem;

BidsDataset dataset() {
    BidsDataset set;
    set.name = "Foveated pictures";
    set.data_origin = "simulated participants";
    set.participant_columns = {{"age", "Age", "year"}};
    set.participants = {{"P01", {"31"}}, {"P02", {""}}};
    set.questionnaires = {
        {"ssq", "Simulator sickness", {{"nausea", "Nausea, 0 to 3", ""}}, {{"P01", {"1"}}}}};
    return set;
}

BidsRun run_of(const std::string& participant, int session) {
    BidsRun run;
    run.participant = participant;
    run.session = session;
    run.event_columns = {{"sigma", "Reduction", ""}, {"identical", "Answer", ""}};
    run.events = {{4.0, 2.5, "kfr", 0.8, {"1.8", "1"}}, {0.5, 2.5, "validation", std::nullopt, {"", "0"}}};
    BidsGaze gaze;
    gaze.sampling_hz = 120.0;
    gaze.pupil_description = "Pupil diameter";
    gaze.average_calibration_error_deg = 0.9;
    gaze.samples = {
        {0.0, 0.1, -0.2, 3.1}, {0.008, std::nullopt, std::nullopt, std::nullopt}, {0.016, 0.3, 0.1, 3.0}};
    gaze.events = {{0.008, 0.008, "blink", ""}};
    run.gaze = {gaze};
    gaze.eye = BidsEye::left;
    gaze.on_screen = true;
    gaze.events.clear();
    run.gaze.push_back(gaze);
    run.screen_refresh_hz = 70.0;
    run.screen_resolution_px = {2560, 1440};
    run.screen_size_m = {0.12, 0.068};
    run.screen_distance_m = 0.05;
    run.motion_hz = 70.0;
    run.motion = {{0.0, 0, 1.6, 0, 0, 0, 0, 1}, {0.014, 0, 1.6, 0.01, 0, 0, 0, 1}};
    return run;
}

class Bids : public ::testing::Test {
  protected:
    void SetUp() override {
        BidsWriter writer(root_, dataset());
        writer.write(run_of("P01", 1));
        writer.write(run_of("P01", 2));
        writer.write(run_of("P02", 1));
    }
    std::string rules() const {
        std::string text;
        for (const BidsViolation& violation : check_bids(root_))
            text += violation.rule + ": " + violation.file.string() + ": " + violation.text + "\n";
        return text;
    }
    TemporaryFolder folder_;
    fs::path root_ = folder_.path() / "bids";
    const std::string beh_ = "sub-P01/ses-01/beh/sub-P01_ses-01_task-pairs_run-1";
    const std::string motion_ = "sub-P01/ses-01/motion/sub-P01_ses-01_task-pairs_tracksys-hmd_run-1";
};

TEST_F(Bids, folder_as_written_keeps_every_rule) {
    EXPECT_EQ(rules(), "");
    for (const std::string& name :
         {beh_ + "_events.tsv", beh_ + "_recording-eye1_physio.tsv.gz",
          beh_ + "_recording-eye3_physioevents.tsv.gz", motion_ + "_motion.tsv", motion_ + "_channels.tsv",
          std::string("phenotype/ssq.json"), std::string("sub-P01/ses-01/sub-P01_ses-01_scans.tsv")})
        EXPECT_TRUE(fs::exists(root_ / name)) << name;
    const std::string events = text_of(root_ / (beh_ + "_events.tsv"));
    EXPECT_TRUE(
        events.starts_with("onset\tduration\ttrial_type\tresponse_time\tsigma\tidentical\n0.500000\t2."
                           "500000\tvalidation\tn/a\tn/a\t0\n"))
        << events;
    const std::string samples = read_gzip_file(root_ / (beh_ + "_recording-eye3_physio.tsv.gz"));
    EXPECT_TRUE(samples.starts_with("0.000000\t0.1000\t-0.2000\t3.1000\n0.008000\tn/a\tn/a\tn/a\n"))
        << samples;
}

TEST_F(Bids, each_rules_violation_is_found) {
    const auto edit_json = [&](const std::string& name, const std::function<void(nlohmann::json&)>& edit) {
        nlohmann::json json = nlohmann::json::parse(text_of(root_ / name));
        edit(json);
        folder_.write("bids/" + name, json.dump());
    };
    const auto replace = [&](const std::string& name, const std::string& from, const std::string& to) {
        std::string text = text_of(root_ / name);
        const std::size_t at = text.find(from);
        ASSERT_NE(at, std::string::npos) << name;
        folder_.write("bids/" + name, text.replace(at, from.size(), to));
    };
    const std::string eye3 = beh_ + "_recording-eye3", eye1 = beh_ + "_recording-eye1";
    const std::vector<std::pair<std::string, std::function<void()>>> cases{
        {"dataset_description",
         [&] { edit_json("dataset_description.json", [](auto& j) { j.erase("BIDSVersion"); }); }},
        {"participants", [&] { replace("participants.tsv", "sub-P02", "sub-P03"); }},
        {"participants", [&] { replace("participants.tsv", "participant_id", "subject"); }},
        {"participants", [&] { replace("participants.tsv", "sub-P02", "sub-P01"); }},
        {"phenotype", [&] { replace("phenotype/ssq.tsv", "sub-P01", "sub-P09"); }},
        {"file_name", [&] { folder_.write("bids/sub-P01/ses-01/beh/notes.txt", "x"); }},
        {"file_name",
         [&] {
             folder_.write("bids/sub-P01/ses-01/beh/sub-P01_ses-01_run-1_task-pairs_beh.tsv", "trial_type\n");
         }},
        {"folder",
         [&] { folder_.write("bids/sub-P01/ses-01/beh/sub-P02_ses-01_task-pairs_run-3_beh.json", "{}"); }},
        {"sidecar", [&] { fs::remove(root_ / (eye3 + "_physio.json")); }},
        {"json", [&] { folder_.write("bids/" + beh_ + "_events.json", "{"); }},
        {"events_columns", [&] { replace(beh_ + "_events.tsv", "onset\tduration", "duration\tonset"); }},
        {"events_columns", [&] { replace(beh_ + "_events.tsv", "4.000000", "later"); }},
        {"events_order", [&] { replace(beh_ + "_events.tsv", "4.000000", "0.100000"); }},
        {"events_alone",
         [&] {
             fs::remove(root_ / (eye1 + "_physio.tsv.gz"));
             fs::remove(root_ / (eye3 + "_physio.tsv.gz"));
         }},
        {"cells", [&] { replace(beh_ + "_events.tsv", "n/a", ""); }},
        {"cells", [&] { replace(beh_ + "_events.tsv", "\tvalidation", ""); }},
        {"gzip", [&] { folder_.write("bids/" + eye3 + "_physio.tsv.gz", "0.0\t1\t1\n"); }},
        {"physio_columns",
         [&] { edit_json(eye3 + "_physio.json", [](auto& j) { j.erase("SamplingFrequency"); }); }},
        {"physio_columns",
         [&] { edit_json(eye3 + "_physio.json", [](auto& j) { j["Columns"][0] = "time"; }); }},
        {"physio_columns",
         [&] { edit_json(eye3 + "_physio.json", [](auto& j) { j["PhysioType"] = "generic"; }); }},
        {"physio_columns",
         [&] {
             write_gzip_file(root_ / (eye3 + "_physio.tsv.gz"),
                             "timestamp\tx_coordinate\ty_coordinate\tpupil_size\n");
         }},
        {"physio_eye",
         [&] { edit_json(eye3 + "_physio.json", [](auto& j) { j["RecordedEye"] = "third"; }); }},
        {"physio_coordinates",
         [&] { edit_json(eye3 + "_physio.json", [](auto& j) { j["SampleCoordinateSystem"] = "screen"; }); }},
        {"physio_coordinates",
         [&] {
             edit_json(eye1 + "_physio.json", [](auto& j) { j["StimulusPresentation"].erase("ScreenSize"); });
         }},
        {"physio_units",
         [&] { edit_json(eye3 + "_physio.json", [](auto& j) { j["x_coordinate"].erase("Units"); }); }},
        {"physio_pupil",
         [&] { edit_json(eye3 + "_physio.json", [](auto& j) { j["pupil_size"]["Description"] = "size"; }); }},
        {"physio_calibration",
         [&] { edit_json(eye3 + "_physio.json", [](auto& j) { j["CalibrationUnit"] = "degree"; }); }},
        {"physioevents_columns",
         [&] { edit_json(eye3 + "_physioevents.json", [](auto& j) { j["Columns"][0] = "start"; }); }},
        {"physioevents_source",
         [&] { edit_json(eye3 + "_physioevents.json", [](auto& j) { j["OnsetSource"] = "n/a"; }); }},
        {"motion_sidecar",
         [&] { edit_json(motion_ + "_motion.json", [](auto& j) { j.erase("TaskName"); }); }},
        {"motion_channels", [&] { fs::remove(root_ / (motion_ + "_channels.tsv")); }},
        {"motion_channels", [&] { replace(motion_ + "_channels.tsv", "ORNT", "TURN"); }},
        {"cells", [&] { replace(motion_ + "_channels.tsv", "latency\tn/a\tLATENCY\tn/a\ts\n", ""); }},
        {"scans", [&] { replace("sub-P01/ses-01/sub-P01_ses-01_scans.tsv", "eye3_physio", "eye4_physio"); }}};
    for (std::size_t i = 0; i < cases.size(); ++i) {
        fs::remove_all(root_);
        SetUp();
        cases[i].second();
        EXPECT_NE(("\n" + rules()).find("\n" + cases[i].first + ": "), std::string::npos)
            << "case " << i << ", rule " << cases[i].first << "\n"
            << rules();
    }
}

TEST_F(Bids, writer_refuses_what_bids_cannot_hold) {
    BidsDataset clash = dataset();
    clash.participants = {{"P-1", {""}}, {"P1", {""}}};
    EXPECT_NE(message_of([&] { BidsWriter(folder_.path() / "x", clash); }).find("'P1'"), std::string::npos);
    BidsWriter writer(folder_.path() / "y", dataset());
    EXPECT_NE(message_of([&] { writer.write(run_of("P77", 1)); }).find("P77"), std::string::npos);
    writer.write(run_of("P01", 1));
    EXPECT_NE(message_of([&] { writer.write(run_of("P01", 1)); }).find("twice"), std::string::npos);
    BidsRun eyes = run_of("P01", 2);
    eyes.gaze.push_back(eyes.gaze[0]);
    EXPECT_NE(message_of([&] { writer.write(eyes); }).find("cyclopean"), std::string::npos);
    BidsRun pupil = run_of("P02", 1);
    pupil.gaze[0].pupil_description.clear();
    EXPECT_NE(message_of([&] { writer.write(pupil); }).find("pupil"), std::string::npos);
    EXPECT_NE(message_of([&] { check_bids(folder_.path() / "none"); }).find("not a folder"),
              std::string::npos);
}

TEST_F(Bids, answers_without_gaze_become_behaviour) {
    BidsRun run = run_of("P02", 2);
    run.gaze.clear();
    fs::remove_all(root_);
    BidsWriter writer(root_, dataset());
    writer.write(run);
    EXPECT_EQ(rules(), "");
    EXPECT_TRUE(fs::exists(root_ / "sub-P02/ses-02/beh/sub-P02_ses-02_task-pairs_run-1_beh.tsv"));
}

TEST(GzipFile, comes_back_and_repeats_to_the_byte) {
    const TemporaryFolder folder;
    std::string text;
    for (std::int64_t i = 0; i < 100'000; ++i) text += std::to_string(i * i) + "\t";
    write_gzip_file(folder.path() / "a.gz", text);
    write_gzip_file(folder.path() / "b.gz", text);
    EXPECT_EQ(read_gzip_file(folder.path() / "a.gz"), text);
    EXPECT_EQ(text_of(folder.path() / "a.gz"), text_of(folder.path() / "b.gz"));
    write_gzip_file(folder.path() / "empty.gz", "");
    EXPECT_EQ(read_gzip_file(folder.path() / "empty.gz"), "");
    const std::string packed = text_of(folder.path() / "a.gz");
    folder.write("cut.gz", packed.substr(0, packed.size() / 2));
    EXPECT_NE(message_of([&] { read_gzip_file(folder.path() / "cut.gz"); }).find("cut.gz"),
              std::string::npos);
}

TEST(LongCsv, reads_back_as_it_was_written_and_has_a_codebook_for_every_column) {
    const TemporaryFolder folder;
    Response response;
    response.participant = "P, \"one\"";
    response.session = 2;
    response.sigma = 1.8;
    response.alpha = 4.0;
    response.identical = true;
    response.scene = "atrium";
    response.trial = 17;
    response.foveated_first = false;
    response.response_time_s = 0.123456789;
    Response missing = response;
    missing.answered = false;
    missing.identical = false;
    missing.excluded_reason = "no answer";
    Response validation = response;
    validation.validation = true;
    LongCsvWriter writer(folder.path(), {{"seed", "Seed of the plan", "", ""}});
    for (const Response& row : {response, missing, validation}) writer.write(row, {"42"});
    writer.finish();
    const auto back = read_responses_csv(writer.table());
    ASSERT_EQ(back.size(), 3u);
    EXPECT_EQ(back[0].participant, response.participant);
    EXPECT_EQ(back[0].sigma, 1.8);
    EXPECT_EQ(back[0].foveated_first, false);
    EXPECT_EQ(back[0].response_time_s, 0.123456789);
    EXPECT_EQ(back[0].trial, 17);
    EXPECT_FALSE(back[1].answered);
    EXPECT_EQ(back[1].excluded_reason, "no answer");
    EXPECT_TRUE(back[2].validation);
    const auto book = nlohmann::json::parse(text_of(writer.codebook()));
    const std::string table = text_of(writer.table());
    const std::string head = table.substr(0, table.find('\n')) + ",";
    for (std::size_t at = 0; at < head.size();) {
        const std::size_t end = head.find(',', at);
        EXPECT_TRUE(book.contains(head.substr(at, end - at))) << head.substr(at, end - at);
        at = end + 1;
    }
    EXPECT_NE(message_of([&] {
                  LongCsvWriter(folder.path(), {{"sigma", "", "", ""}});
              }).find("'sigma'"),
              std::string::npos);
}

}  // namespace
}  // namespace parafovea
