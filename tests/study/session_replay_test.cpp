// A recorded session comes out the same again, and any change of the recording is found.
#include "study/session_replay.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "devices/random.h"
#include "study/database.h"
#include "study/migrations.h"
#include "study/schema.h"
#include "study/session_log_reader.h"
#include "tests/study/lab.h"

namespace parafovea {
namespace {

using test::ProgramRun;
using test::start;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// A session with tracked foveation, blinks, misses, unanswered trials and an interruption.
void record_session(const std::filesystem::path& path) {
    Protocol protocol = parse_protocol(
        test::small_protocol_text() +
            "[foveation]\ngaze = \"tracked\"\nstale_after_ms = 25\n[validity]\ngaze_off_center_deg = 4\n",
        "small.toml");
    protocol.source =
        test::small_protocol_text() +
        "[foveation]\ngaze = \"tracked\"\nstale_after_ms = 25\n[validity]\ngaze_off_center_deg = 4\n";
    {
        SessionLog log = start(path, protocol);
        ProgramRun run;
        run.gaze.to_come.clear();
        Random random(4);
        for (int i = 0; i < 3000; ++i) {
            const bool blink = i % 40 < 6;
            run.gaze.look(i * 0.01, i * 0.01 + 0.01,
                          blink ? std::nullopt
                                : std::optional(DirectionDeg{random.normal(0, 1.5), random.normal(0, 1.5)}));
        }
        run.stage.late = {60, 61, 200, 333};
        std::stop_source stop;
        SessionHooks hooks;
        hooks.stop = stop.get_token();
        const auto before_show = run.stage.before_show;
        run.stage.before_show = [&, n = 0](const Picture& picture) mutable {
            before_show(picture);
            if (++n == 400) stop.request_stop();
        };
        ASSERT_EQ(run.go(log, hooks), SessionEnd::stopped);
    }
    SessionLog log = test::resume(path);
    ProgramRun run;
    ASSERT_EQ(run.go(log), SessionEnd::finished);
}

std::uint64_t fake_hash(const Picture& picture) {
    return std::hash<std::string>()(picture.scene + to_text(picture.method));
}

TEST(Replay, a_recorded_session_comes_out_the_same_to_the_last_row_and_image) {
    TemporaryFolder folder;
    record_session(folder / "s.sqlite");
    int calls = 0;
    const ReplayReport report = replay_session(
        folder / "s.sqlite",
        [](const Picture& picture, const ShownFrame&) -> std::optional<std::uint64_t> {
            if (picture.kind != PictureKind::stimulus) return std::nullopt;
            return fake_hash(picture);
        },
        [&](int, int) { ++calls; });
    EXPECT_THAT(report.differences, IsEmpty());
    const SessionRows rows = read_session(folder / "s.sqlite");
    EXPECT_EQ(report.trials, static_cast<int>(rows.trials.size()));
    EXPECT_GT(report.trials, 13);
    EXPECT_GT(report.images, 13 * 40 - 40);
    EXPECT_EQ(calls, report.trials + 1);
    // The recording has what makes replay hard.
    int fallbacks = 0, invalid = 0, interrupted = 0;
    for (const TrialRow& trial : rows.trials) {
        for (const FrameRecord& frame : read_frames(folder / "s.sqlite", trial.planned.number, trial.attempt))
            fallbacks += frame.fallback;
        invalid += !trial.invalid.empty();
        interrupted += trial.interrupted;
    }
    EXPECT_GT(fallbacks, 10);
    EXPECT_GT(invalid, 0);
    EXPECT_EQ(interrupted, 1);
}

TEST(Replay, an_image_that_comes_out_differently_is_named) {
    TemporaryFolder folder;
    record_session(folder / "s.sqlite");
    int images = 0;
    const ReplayReport report = replay_session(
        folder / "s.sqlite", [&](const Picture& picture, const ShownFrame&) -> std::optional<std::uint64_t> {
            if (picture.kind != PictureKind::stimulus) return std::nullopt;
            return fake_hash(picture) + (++images == 45);
        });
    EXPECT_THAT(report.differences, ElementsAre(HasSubstr("is another picture")));
}

TEST(Replay, one_flipped_bit_in_any_stored_gaze_value_is_found) {
    TemporaryFolder folder;
    record_session(folder / "s.sqlite");
    Random random(8);
    for (const char* column :
         {"sequence", "device_ns", "host_ns", "host_error_ns", "arrival_host_ns", "status"}) {
        const auto path = folder / (std::string(column) + ".sqlite");
        std::filesystem::copy_file(folder / "s.sqlite", path);
        Database database(path, Database::Mode::write);
        const std::int64_t bit = column == std::string("status") ? 1 : std::int64_t{1} << random.below(60);
        database
            .prepare("UPDATE gaze SET " + std::string(column) + " = (" + column + " | ?) - (" + column +
                     " & ?) WHERE trial_id = ? AND n = ?")
            .bind_all(bit, bit, 1 + static_cast<int>(random.below(5)), static_cast<int>(random.below(50)))
            .run();
        EXPECT_THAT(replay_session(path).differences, testing::Not(IsEmpty())) << column;
    }
    for (const char* column :
         {"azimuth_deg", "elevation_deg", "left_azimuth_deg", "left_elevation_deg", "left_pupil_mm"}) {
        const auto path = folder / (std::string(column) + ".sqlite");
        std::filesystem::copy_file(folder / "s.sqlite", path);
        {
            Database database(path, Database::Mode::write);
            Statement read =
                database.prepare("SELECT trial_id, n, " + std::string(column) + " FROM gaze WHERE " + column +
                                 " IS NOT NULL ORDER BY trial_id, n LIMIT 1 OFFSET 30");
            ASSERT_TRUE(read.step());
            const double flipped =
                std::bit_cast<double>(std::bit_cast<std::uint64_t>(read.real(2)) ^ (1u << random.below(32)));
            database.prepare("UPDATE gaze SET " + std::string(column) + " = ? WHERE trial_id = ? AND n = ?")
                .bind_all(flipped, read.integer(0), read.integer(1))
                .run();
        }
        EXPECT_THAT(replay_session(path).differences, testing::Not(IsEmpty())) << column;
    }
}

TEST(Replay, a_change_of_the_trial_rows_the_plan_or_the_protocol_is_found) {
    TemporaryFolder folder;
    record_session(folder / "s.sqlite");
    for (const char* change :
         {"UPDATE response SET identical = 1 - identical WHERE trial_id = 3",
          "DELETE FROM response WHERE trial_id = 2",
          "UPDATE frame SET fovea_x_px = fovea_x_px + 1e-9 WHERE trial_id = 1 AND phase = 1",
          "UPDATE interval SET presented_frames = 19 WHERE trial_id = 2 AND phase = 3",
          "DELETE FROM gaze WHERE trial_id = 4 AND n = 9", "DELETE FROM controller_event WHERE trial_id = 4",
          "UPDATE plan SET scene = 'three' WHERE trial = 12", "UPDATE session SET seed = seed + 1",
          "UPDATE experiment SET protocol_text = protocol_text || ' '", "DELETE FROM flag WHERE flag = 1"}) {
        const auto path = folder / "changed.sqlite";
        std::filesystem::copy_file(folder / "s.sqlite", path,
                                   std::filesystem::copy_options::overwrite_existing);
        { Database(path, Database::Mode::write).execute(change); }
        EXPECT_THAT(replay_session(path).differences, testing::Not(IsEmpty())) << change;
    }
}

std::string old_session() {
    std::ifstream file(PARAFOVEA_SOURCE_DIR "/tests/study/golden/session_version_1.sql");
    std::stringstream text;
    text << file.rdbuf();
    return text.str();
}

void make_old_session(const std::filesystem::path& path) {
    std::ofstream(path).close();
    Database(path, Database::Mode::write).execute(old_session().c_str());
}

TEST(Migrations, a_session_of_version_1_is_read_without_being_changed) {
    TemporaryFolder folder;
    make_old_session(folder / "old.sqlite");
    const SessionRows rows = read_session(folder / "old.sqlite");
    EXPECT_EQ(rows.facts.participant, "old");
    EXPECT_EQ(rows.trials.size(), 7u);
    EXPECT_EQ(rows.facts.view.size, (SizePx{640, 480}));
    EXPECT_EQ(read_frames(folder / "old.sqlite", 3).size(), 21u);
    EXPECT_EQ(Database(folder / "old.sqlite", Database::Mode::read).user_version(), 1);
    EXPECT_THAT(replay_session(folder / "old.sqlite").differences,
                testing::Contains(HasSubstr("replay it exactly")));
}

TEST(Migrations, an_old_session_gets_the_tables_of_a_new_one) {
    TemporaryFolder folder;
    make_old_session(folder / "old.sqlite");
    Database old_one(folder / "old.sqlite", Database::Mode::write);
    migrate(old_one);
    EXPECT_EQ(old_one.user_version(), kSchemaVersion);
    { start(folder / "new.sqlite"); }
    Database new_one(folder / "new.sqlite", Database::Mode::read);
    const auto columns = [](Database& database) {
        std::set<std::string> names;
        Statement row = database.prepare(
            "SELECT m.type || ' ' || m.name || ' ' || c.name || ' ' || c.type || c.\"notnull\" || c.pk FROM "
            "sqlite_master m, "
            "pragma_table_info(m.name) c");
        while (row.step()) names.insert(row.text(0));
        return names;
    };
    EXPECT_EQ(columns(old_one), columns(new_one));
}

TEST(Migrations, an_old_session_can_be_opened_to_go_on) {
    TemporaryFolder folder;
    make_old_session(folder / "old.sqlite");
    {
        Database(folder / "old.sqlite", Database::Mode::write)
            .execute(
                "DELETE FROM flag; UPDATE session SET finished_host_ns = NULL; UPDATE trial SET superseded = "
                "1 WHERE trial > 3");
    }
    {
        SessionLog log = test::resume(folder / "old.sqlite");
        EXPECT_EQ(ProgramRun().go(log), SessionEnd::finished);
    }
    EXPECT_EQ(read_session(folder / "old.sqlite").trials.size(), 10u);
}

TEST(Migrations, a_session_from_a_newer_program_is_refused) {
    TemporaryFolder folder;
    { start(folder / "s.sqlite"); }
    { Database(folder / "s.sqlite", Database::Mode::write).execute("PRAGMA user_version = 99"); }
    EXPECT_THROW(read_session(folder / "s.sqlite"), std::runtime_error);
    try {
        test::resume(folder / "s.sqlite");
        FAIL();
    } catch (const std::runtime_error& error) {
        EXPECT_THAT(error.what(), HasSubstr("use the program that made it"));
    }
}

}  // namespace
}  // namespace parafovea
