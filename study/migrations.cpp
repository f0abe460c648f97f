// The changes of the schema, version by version.
#include "study/migrations.h"

#include <stdexcept>

#include "study/protocol.h"
#include "study/schema.h"
#include "study/session_rows.h"

namespace parafovea {
namespace {

// 2: the view, levels of adaptive procedures, a hash of every showing's values, and what each frame knew, so
// that a session can be replayed exactly.
void to_version_2(Database& database) {
    const ViewGeometry view =
        parse_protocol(read_protocol_text(database, nullptr), database.path()).display.view;
    database.execute(
        "ALTER TABLE trial ADD COLUMN level REAL;"
        "ALTER TABLE trial ADD COLUMN content_hash INTEGER;"
        "ALTER TABLE frame ADD COLUMN gaze_known INTEGER;"
        "ALTER TABLE frame ADD COLUMN events_known INTEGER;"
        "ALTER TABLE frame ADD COLUMN fault TEXT;"
        "ALTER TABLE session ADD COLUMN view_width_px INTEGER NOT NULL DEFAULT 0;"
        "ALTER TABLE session ADD COLUMN view_height_px INTEGER NOT NULL DEFAULT 0;"
        "ALTER TABLE session ADD COLUMN view_fov_deg REAL NOT NULL DEFAULT 0;");
    database.prepare("UPDATE session SET view_width_px = ?, view_height_px = ?, view_fov_deg = ?")
        .bind_all(view.size.width, view.size.height, view.horizontal_fov_deg)
        .run();
}

// 3: gaze between the showings has a table of its own; drift checks stand beside calibrations.
void to_version_3(Database& database) {
    database.execute(
        "ALTER TABLE calibration ADD COLUMN kind TEXT NOT NULL DEFAULT 'calibration';"
        "CREATE TABLE gaze_between (n INTEGER PRIMARY KEY, anchor INTEGER NOT NULL REFERENCES clock_anchor, "
        "phase TEXT NOT NULL, sequence INTEGER NOT NULL, device_ns INTEGER NOT NULL, host_ns INTEGER NOT "
        "NULL, host_error_ns INTEGER NOT NULL, arrival_host_ns INTEGER NOT NULL, status INTEGER NOT NULL, "
        "azimuth_deg REAL, elevation_deg REAL, left_azimuth_deg REAL, left_elevation_deg REAL, "
        "left_pupil_mm REAL, right_azimuth_deg REAL, right_elevation_deg REAL, right_pupil_mm REAL, "
        "eyes INTEGER NOT NULL);");
}

using Step = void (*)(Database&);
constexpr Step kSteps[] = {to_version_2, to_version_3};
static_assert(std::size(kSteps) == kSchemaVersion - 1);

void refuse_unknown_version(const std::string& path, std::int64_t version) {
    if (version >= 1 && version <= kSchemaVersion) return;
    throw std::runtime_error(
        path + ": expected a session file of version " + std::to_string(kSchemaVersion) +
        " or earlier, found version " + std::to_string(version) +
        (version > kSchemaVersion ? "; use the program that made it" : "; check that it is a session file"));
}

}  // namespace

void migrate(Database& database) {
    std::int64_t version = database.user_version();
    refuse_unknown_version(database.path(), version);
    for (; version < kSchemaVersion; ++version) {
        Transaction transaction(database);
        kSteps[version - 1](database);
        database.execute(("PRAGMA user_version = " + std::to_string(version + 1)).c_str());
        transaction.commit();
    }
}

std::unique_ptr<Database> open_for_reading(const std::filesystem::path& path) {
    auto file = std::make_unique<Database>(path, Database::Mode::read);
    const std::int64_t version = file->user_version();
    refuse_unknown_version(file->path(), version);
    if (version == kSchemaVersion) return file;
    std::unique_ptr<Database> copy = file->copy_in_memory();
    migrate(*copy);
    return copy;
}

}  // namespace parafovea
