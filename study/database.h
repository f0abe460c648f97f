// SQLite with destructors and exceptions.
#pragma once

#include <sqlite3.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace parafovea {

// A prepared statement. Parameters are numbered from 1 in the order of bind calls, columns from 0.
class Statement {
  public:
    Statement(sqlite3* database, std::string path, std::string_view sql);
    Statement(Statement&& other) noexcept;
    Statement(const Statement&) = delete;
    Statement& operator=(const Statement&) = delete;
    ~Statement();

    Statement& bind(std::int64_t value);
    Statement& bind(int value) { return bind(static_cast<std::int64_t>(value)); }
    Statement& bind(bool value) { return bind(static_cast<std::int64_t>(value)); }
    Statement& bind(double value);
    Statement& bind(std::string_view value);
    Statement& bind(const char* value) { return bind(std::string_view(value)); }
    Statement& bind(std::nullopt_t);
    template <typename Value>
    Statement& bind(const std::optional<Value>& value) {
        return value ? bind(*value) : bind(std::nullopt);
    }
    template <typename... Values>
    Statement& bind_all(const Values&... values) {
        (bind(values), ...);
        return *this;
    }

    // Runs to the next row; false after the last. Throws std::runtime_error on any failure.
    bool step();
    // Runs a statement that gives no rows, and makes it ready to be bound again.
    void run();
    // Makes it ready to be bound and stepped again, with rows left or not.
    Statement& reset();

    bool is_null(int column) const;
    std::int64_t integer(int column) const;
    double real(int column) const;
    std::string text(int column) const;
    std::optional<std::int64_t> optional_integer(int column) const;
    std::optional<double> optional_real(int column) const;

  private:
    void check(int code, const char* doing);

    std::string path_;
    sqlite3_stmt* statement_ = nullptr;
    int bound_ = 0;
};

class Database {
  public:
    enum class Mode { read, write };

    // Throws std::runtime_error where the file cannot be opened. `vfs` names another SQLite VFS than the
    // default.
    Database(const std::filesystem::path& path, Mode mode, const char* vfs = nullptr);
    Database(const Database&) = delete;
    Database& operator=(const Database&) = delete;
    ~Database();

    // All of it in memory, open for writing.
    std::unique_ptr<Database> copy_in_memory();

    void execute(const char* sql);
    Statement prepare(std::string_view sql) { return Statement(handle_, path_, sql); }
    std::int64_t last_row_id() const { return sqlite3_last_insert_rowid(handle_); }
    std::int64_t user_version();
    const std::string& path() const { return path_; }

  private:
    std::string path_;
    sqlite3* handle_ = nullptr;
};

// Rolled back unless committed.
class Transaction {
  public:
    explicit Transaction(Database& database) : database_(database) { database_.execute("BEGIN IMMEDIATE"); }
    Transaction(const Transaction&) = delete;
    Transaction& operator=(const Transaction&) = delete;
    ~Transaction();
    void commit();

  private:
    Database& database_;
    bool open_ = true;
};

}  // namespace parafovea
