// Calls SQLite and turns its failures into one clear line.
#include "study/database.h"

#include <stdexcept>
#include <utility>

namespace parafovea {
namespace {

std::string advice(int code) {
    switch (code & 0xff) {
        case SQLITE_FULL:
            return "free some space";
        case SQLITE_IOERR:
            return "check the disk";
        case SQLITE_BUSY:
        case SQLITE_LOCKED:
            return "close the other program that uses it";
        case SQLITE_CANTOPEN:
        case SQLITE_PERM:
        case SQLITE_READONLY:
            return "check that the path exists and may be read and written";
        case SQLITE_NOTADB:
        case SQLITE_CORRUPT:
            return "check that it is a session file";
        default:
            return "check the file";
    }
}

[[noreturn]] void fail(const std::string& path, const char* doing, int code, sqlite3* handle) {
    const std::string what = handle ? sqlite3_errmsg(handle) : sqlite3_errstr(code);
    throw std::runtime_error(path + ": expected to " + doing + " the session file, found \"" + what + "\"; " +
                             advice(code));
}

}  // namespace

Statement::Statement(sqlite3* database, std::string path, std::string_view sql) : path_(std::move(path)) {
    const int code =
        sqlite3_prepare_v2(database, sql.data(), static_cast<int>(sql.size()), &statement_, nullptr);
    if (code != SQLITE_OK) fail(path_, "read", code, database);
}

Statement::Statement(Statement&& other) noexcept
    : path_(std::move(other.path_)),
      statement_(std::exchange(other.statement_, nullptr)),
      bound_(other.bound_) {}

Statement::~Statement() {
    sqlite3_finalize(statement_);
}

void Statement::check(int code, const char* doing) {
    if (code != SQLITE_OK) fail(path_, doing, code, sqlite3_db_handle(statement_));
}

Statement& Statement::bind(std::int64_t value) {
    check(sqlite3_bind_int64(statement_, ++bound_, value), "write");
    return *this;
}

Statement& Statement::bind(double value) {
    check(sqlite3_bind_double(statement_, ++bound_, value), "write");
    return *this;
}

Statement& Statement::bind(std::string_view value) {
    check(sqlite3_bind_text(statement_, ++bound_, value.data(), static_cast<int>(value.size()),
                            SQLITE_TRANSIENT),
          "write");
    return *this;
}

Statement& Statement::bind(std::nullopt_t) {
    check(sqlite3_bind_null(statement_, ++bound_), "write");
    return *this;
}

bool Statement::step() {
    const int code = sqlite3_step(statement_);
    if (code == SQLITE_ROW) return true;
    if (code != SQLITE_DONE) {
        const bool reads = sqlite3_stmt_readonly(statement_) != 0;
        fail(path_, reads ? "read" : "write", code, sqlite3_db_handle(statement_));
    }
    return false;
}

void Statement::run() {
    step();
    reset();
}

Statement& Statement::reset() {
    sqlite3_reset(statement_);
    bound_ = 0;
    return *this;
}

bool Statement::is_null(int column) const {
    return sqlite3_column_type(statement_, column) == SQLITE_NULL;
}
std::int64_t Statement::integer(int column) const {
    return sqlite3_column_int64(statement_, column);
}
double Statement::real(int column) const {
    return sqlite3_column_double(statement_, column);
}

std::string Statement::text(int column) const {
    const unsigned char* text = sqlite3_column_text(statement_, column);
    return text ? std::string(reinterpret_cast<const char*>(text),
                              static_cast<std::size_t>(sqlite3_column_bytes(statement_, column)))
                : std::string();
}

std::optional<std::int64_t> Statement::optional_integer(int column) const {
    return is_null(column) ? std::nullopt : std::optional(integer(column));
}

std::optional<double> Statement::optional_real(int column) const {
    return is_null(column) ? std::nullopt : std::optional(real(column));
}

Database::Database(const std::filesystem::path& path, Mode mode, const char* vfs) : path_(path.string()) {
    // A reader belongs to one thread, which then need not lock at every column of every row.
    const int flags = mode == Mode::read ? SQLITE_OPEN_READONLY | SQLITE_OPEN_NOMUTEX : SQLITE_OPEN_READWRITE;
    const int code = sqlite3_open_v2(path_.c_str(), &handle_, flags, vfs);
    if (code == SQLITE_OK) {
        sqlite3_busy_timeout(handle_, 5000);
        sqlite3_extended_result_codes(handle_, 1);
        return;
    }
    sqlite3_close_v2(std::exchange(handle_, nullptr));
    fail(path_, "open", code, nullptr);
}

Database::~Database() {
    sqlite3_close_v2(handle_);
}

std::unique_ptr<Database> Database::copy_in_memory() {
    auto copy = std::make_unique<Database>(":memory:", Mode::write);
    sqlite3_backup* backup = sqlite3_backup_init(copy->handle_, "main", handle_, "main");
    if (backup == nullptr) fail(path_, "read", sqlite3_errcode(copy->handle_), copy->handle_);
    sqlite3_backup_step(backup, -1);
    const int code = sqlite3_backup_finish(backup);
    if (code != SQLITE_OK) fail(path_, "read", code, copy->handle_);
    copy->path_ = path_;
    return copy;
}

void Database::execute(const char* sql) {
    const int code = sqlite3_exec(handle_, sql, nullptr, nullptr, nullptr);
    if (code != SQLITE_OK) fail(path_, "use", code, handle_);
}

std::int64_t Database::user_version() {
    Statement statement = prepare("PRAGMA user_version");
    return statement.step() ? statement.integer(0) : 0;
}

Transaction::~Transaction() {
    if (!open_) return;
    try {
        database_.execute("ROLLBACK");
    } catch (const std::exception&) {
        // SQLite has rolled back by itself; the failure that led here is already on its way to the caller.
    }
}

void Transaction::commit() {
    database_.execute("COMMIT");
    open_ = false;
}

}  // namespace parafovea
