// Queues what a session produces for a thread that writes it, one durable transaction after the other.
#include "study/session_log.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <random>
#include <set>
#include <stdexcept>
#include <thread>
#include <utility>

#include "study/database.h"
#include "study/migrations.h"
#include "study/schema.h"
#include "study/session_file_lock.h"
#include "study/session_rows.h"

namespace parafovea {
namespace {

// What each session's pages of text are called; see session_runner.cpp.
std::string session_prefix(int session) {
    return "session " + std::to_string(session);
}

void set_up_connection(Database& database) {
    database.execute("PRAGMA journal_mode = WAL");
    database.execute("PRAGMA synchronous = FULL");
    database.execute("PRAGMA foreign_keys = ON");
}

// The wall clock's time of the last thing stored, ns.
std::int64_t last_wall_ns(Database& database) {
    Statement row = database.prepare(
        "SELECT max(a.wall_ns + coalesce(t.last_ns, a.host_ns) - a.host_ns) FROM clock_anchor a LEFT JOIN "
        "(SELECT anchor, max(ns) AS last_ns FROM (SELECT anchor, host_ns AS ns FROM event UNION ALL "
        "SELECT anchor, end_host_ns FROM trial JOIN interval USING (trial_id)) GROUP BY anchor) t USING "
        "(anchor)");
    return row.step() ? row.integer(0) : 0;
}

}  // namespace

struct SessionLog::State {
    State(SessionFileLock held, const std::filesystem::path& path, const char* vfs = nullptr)
        : lock(std::move(held)), database(path, Database::Mode::write, vfs) {}

    ~State() {
        {
            const std::lock_guard guard(mutex);
            closing = true;
        }
        work.notify_all();
        if (writer.joinable()) writer.join();
    }

    void start_writer() {
        writer = std::thread([this] { write_all(); });
    }

    void write_all() {
        std::unique_lock guard(mutex);
        while (true) {
            work.wait(guard, [this] { return closing || !jobs.empty(); });
            if (jobs.empty()) return;
            const std::function<void(Database&)> job = std::move(jobs.front());
            jobs.pop_front();
            guard.unlock();
            std::exception_ptr thrown;
            try {
                Transaction transaction(database);
                job(database);
                transaction.commit();
            } catch (...) {
                thrown = std::current_exception();
            }
            guard.lock();
            --unwritten;
            if (thrown) {
                // Nothing later may be stored without what came before it.
                failure = thrown;
                unwritten = 0;
                jobs.clear();
            }
            settled.notify_all();
        }
    }

    void enqueue(std::function<void(Database&)> job) {
        {
            const std::lock_guard guard(mutex);
            if (failure) std::rethrow_exception(failure);
            jobs.push_back(std::move(job));
            ++unwritten;
        }
        work.notify_all();
    }

    SessionFileLock lock;
    Database database;  // the writer's alone once it has started
    Protocol protocol;
    TrialPlan plan;
    std::vector<ShownTrial> shown;
    std::set<std::string> pages_left, questionnaires;
    bool simulated_people = false;
    std::int64_t anchor = 0;
    double age_h = 0;
    bool resumed = false, finished = false;

    std::mutex mutex;
    std::condition_variable work, settled;
    std::deque<std::function<void(Database&)>> jobs;
    int unwritten = 0;
    std::exception_ptr failure;
    bool closing = false;
    std::thread writer;
};

ClockAnchor read_clock_anchor(HostTime now) {
    const auto since_1970 = std::chrono::system_clock::now().time_since_epoch();
    return {now, std::chrono::duration_cast<std::chrono::nanoseconds>(since_1970).count()};
}

std::string make_uuid() {
    std::random_device device;
    unsigned words[4];
    for (unsigned& word : words) word = device();
    words[1] = (words[1] & 0xffff0fffu) | 0x4000u;
    words[2] = (words[2] & 0x3fffffffu) | 0x80000000u;
    char text[37];
    std::snprintf(text, sizeof text, "%08x-%04x-%04x-%04x-%04x%08x", words[0], words[1] >> 16,
                  words[1] & 0xffff, words[2] >> 16, words[2] & 0xffff, words[3]);
    return text;
}

SessionLog::SessionLog(std::unique_ptr<State> state) : state_(std::move(state)) {}
SessionLog::SessionLog(SessionLog&&) noexcept = default;
SessionLog::~SessionLog() = default;

SessionLog SessionLog::create(const std::filesystem::path& path, const SessionFacts& facts,
                              const Protocol& protocol, const TrialPlan& plan, ClockAnchor anchor,
                              const char* vfs) {
    SessionFileLock lock(path, SessionFileLock::Mode::create);
    try {
        auto state = std::make_unique<State>(std::move(lock), path, vfs);
        write_new_file(*state, facts, protocol, plan, anchor);
        state->start_writer();
        return SessionLog(std::move(state));
    } catch (...) {
        // Half a file would only be in the way.
        std::error_code ignored;
        for (const char* end : {"", "-wal", "-shm"}) std::filesystem::remove(path.string() + end, ignored);
        throw;
    }
}

void SessionLog::write_new_file(State& state, const SessionFacts& facts, const Protocol& protocol,
                                const TrialPlan& plan, ClockAnchor anchor) {
    Database& database = state.database;
    set_up_connection(database);
    Transaction transaction(database);
    database.execute(kSchemaSql);
    database.execute(("PRAGMA user_version = " + std::to_string(kSchemaVersion)).c_str());
    write_experiment(database, protocol);
    SessionFacts complete = facts;
    if (complete.view.size.width == 0) complete.view = protocol.display.view;
    write_session(database, complete, plan);
    write_plan(database, plan, protocol);
    state.anchor = write_anchor(database, anchor);
    transaction.commit();
    state.protocol = protocol;
    state.plan = plan;
    state.simulated_people = facts.simulated_people;
}

SessionLog SessionLog::open_to_resume(const std::filesystem::path& path, ClockAnchor anchor) {
    auto state = std::make_unique<State>(SessionFileLock(path, SessionFileLock::Mode::open), path);
    Database& database = state->database;
    migrate(database);
    set_up_connection(database);
    std::string file_name;
    const std::string text = read_protocol_text(database, &file_name);
    state->protocol = parse_protocol(text, file_name);
    state->plan = read_plan(database);
    state->shown = read_shown(database);
    state->age_h = std::max<double>(0, static_cast<double>(anchor.wall_ns - last_wall_ns(database))) / 3.6e12;
    Statement pages = database.prepare("SELECT detail FROM event WHERE kind = 'page'");
    while (pages.step()) state->pages_left.insert(pages.text(0));
    Statement asked = database.prepare("SELECT name FROM questionnaire");
    while (asked.step()) state->questionnaires.insert(asked.text(0));
    state->simulated_people = read_facts(database).simulated_people;
    Statement finished = database.prepare("SELECT finished_host_ns FROM session");
    state->finished = finished.step() && !finished.is_null(0);
    state->resumed = true;
    Transaction transaction(database);
    state->anchor = write_anchor(database, anchor);
    transaction.commit();
    state->start_writer();
    return SessionLog(std::move(state));
}

const Protocol& SessionLog::protocol() const {
    return state_->protocol;
}
const TrialPlan& SessionLog::plan() const {
    return state_->plan;
}
const std::vector<ShownTrial>& SessionLog::shown() const {
    return state_->shown;
}
bool SessionLog::page_was_left(const std::string& page) const {
    return state_->pages_left.contains(page);
}
bool SessionLog::was_asked(const std::string& questionnaire) const {
    return state_->questionnaires.contains(questionnaire);
}
bool SessionLog::simulated_people() const {
    return state_->simulated_people;
}
bool SessionLog::resumed() const {
    return state_->resumed;
}
bool SessionLog::finished() const {
    return state_->finished;
}
double SessionLog::age_h() const {
    return state_->age_h;
}

void SessionLog::append(TrialRecord record) {
    ShownTrial shown;
    shown.number = record.planned.number;
    shown.attempt = record.attempt;
    shown.answered = record.answer.has_value();
    shown.identical = record.answer && record.answer->identical;
    shown.valid = record.invalid.empty();
    shown.interrupted = record.interrupted;
    shown.level = record.level;
    state_->enqueue([record = std::move(record), anchor = state_->anchor](Database& database) {
        write_trial(database, record, anchor);
    });
    state_->shown.push_back(shown);
}

void SessionLog::append_calibration(CalibrationRecord record) {
    state_->enqueue([record = std::move(record), anchor = state_->anchor](Database& database) {
        write_calibration(database, record, anchor);
    });
}

void SessionLog::append_gaze(std::string phase, std::vector<GazeSample> samples) {
    state_->enqueue([phase = std::move(phase), samples = std::move(samples), anchor = state_->anchor](
                        Database& database) { write_gaze_between(database, phase, samples, anchor); });
}

void SessionLog::append_page(HostTime time, const std::string& page) {
    append_event(time, "page", page);
    state_->pages_left.insert(page);
}

void SessionLog::append_event(HostTime time, std::string kind, std::string detail) {
    state_->enqueue([=, anchor = state_->anchor](Database& database) {
        database.prepare("INSERT INTO event VALUES (NULL, ?, ?, ?, ?)")
            .bind_all(anchor, time.ns, kind, detail)
            .run();
    });
}

void SessionLog::append_note(HostTime time, std::string text) {
    state_->enqueue([=, anchor = state_->anchor](Database& database) {
        database.prepare("INSERT INTO note VALUES (NULL, ?, ?, ?)").bind_all(anchor, time.ns, text).run();
    });
}

void SessionLog::append_questionnaire(HostTime time, std::string name,
                                      std::map<std::string, std::string> answers) {
    state_->questionnaires.insert(name);
    state_->enqueue([=, anchor = state_->anchor](Database& database) {
        database.prepare("INSERT INTO questionnaire VALUES (NULL, ?, ?, ?)")
            .bind_all(anchor, time.ns, name)
            .run();
        const std::int64_t questionnaire = database.last_row_id();
        Statement insert = database.prepare("INSERT INTO questionnaire_answer VALUES (?, ?, ?)");
        for (const auto& [question, answer] : answers) insert.bind_all(questionnaire, question, answer).run();
    });
}

void SessionLog::supersede_trial(int trial_number) {
    state_->enqueue([=](Database& database) {
        database.prepare("UPDATE trial SET superseded = 1 WHERE trial = ?").bind_all(trial_number).run();
    });
    for (ShownTrial& shown : state_->shown)
        if (shown.number == trial_number) shown.superseded = true;
}

void SessionLog::supersede_session(int session) {
    for (const PlannedTrial& trial : state_->plan.trials)
        if (trial.session == session) supersede_trial(trial.number);
    state_->enqueue([=](Database& database) {
        database.prepare("UPDATE event SET kind = 'superseded page' WHERE kind = 'page' AND detail = ?")
            .bind_all(session_prefix(session))
            .run();
    });
    state_->pages_left.erase(session_prefix(session));
}

void SessionLog::finish(HostTime time) {
    state_->enqueue([=](Database& database) {
        database.prepare("UPDATE session SET finished_host_ns = ?").bind_all(time.ns).run();
    });
    state_->finished = true;
}

bool SessionLog::durable() {
    const std::lock_guard guard(state_->mutex);
    if (state_->failure) std::rethrow_exception(state_->failure);
    return state_->unwritten == 0;
}

void SessionLog::wait_until_durable() {
    std::unique_lock guard(state_->mutex);
    state_->settled.wait(guard, [this] { return state_->unwritten == 0; });
    if (state_->failure) std::rethrow_exception(state_->failure);
}

}  // namespace parafovea
