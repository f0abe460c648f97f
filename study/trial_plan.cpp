// Draws a participant's plan: training, then each session's conditions, validation trials, scenes and
// interval orders.
#include "study/trial_plan.h"

#include <algorithm>
#include <cassert>
#include <charconv>
#include <numeric>
#include <ostream>

#include "devices/random.h"
#include "study/counterbalance.h"

namespace parafovea {
namespace {

// One thing a session shows: a condition with a scene. With one scene a session, items are just the
// conditions.
struct Item {
    int condition = 0;
    std::string scene;
};

std::vector<int> counted(int n) {
    std::vector<int> numbers(static_cast<std::size_t>(n));
    std::iota(numbers.begin(), numbers.end(), 0);
    return numbers;
}

// Independent draws for each purpose, so that a change of one part of a protocol leaves the others' draws as
// they were.
Random stream_for(std::uint64_t seed, int participant_index, const std::string& purpose) {
    return Random::stream(seed, purpose + " of participant " + std::to_string(participant_index));
}

class Planner {
  public:
    Planner(const Protocol& protocol, int participant_index, std::uint64_t seed)
        : protocol_(protocol), design_(protocol.design), participant_(participant_index), seed_(seed) {
        plan_.participant_index = participant_index;
        plan_.seed = seed;
    }

    TrialPlan make() {
        add_training();
        for (int session = 1; session <= design_.sessions; ++session) add_session(session);
        return std::move(plan_);
    }

  private:
    int scene_count() const { return static_cast<int>(protocol_.scenes.size()); }

    const std::string& scene_of_session(int session) const {
        return protocol_.scenes[static_cast<std::size_t>((session - 1 + participant_) % scene_count())];
    }

    std::vector<Item> items_of_session(int session) const {
        std::vector<Item> items;
        const bool crossed = design_.scene_use == SceneUse::crossed;
        for (int condition = 0; condition < static_cast<int>(protocol_.conditions.size()); ++condition) {
            if (!crossed) items.push_back({condition, scene_of_session(session)});
            if (crossed)
                for (const std::string& scene : protocol_.scenes) items.push_back({condition, scene});
        }
        return items;
    }

    void add(int session, int block, TrialKind kind, const Item& item, int reference_interval) {
        PlannedTrial trial;
        trial.number = static_cast<int>(plan_.trials.size());
        trial.session = session;
        trial.block = block;
        const bool same_session = !plan_.trials.empty() && plan_.trials.back().session == session;
        trial.position = same_session ? plan_.trials.back().position + 1 : 0;
        trial.kind = kind;
        trial.condition = kind == TrialKind::validation ? -1 : item.condition;
        trial.reference_interval = reference_interval;
        trial.scene = item.scene;
        trial.first = trial.second = protocol_.reference;
        if (kind != TrialKind::validation)
            (reference_interval == 0 ? trial.second : trial.first) =
                protocol_.conditions[static_cast<std::size_t>(item.condition)];
        plan_.trials.push_back(std::move(trial));
    }

    // Which interval shows the reference, for `count` trials.
    std::vector<int> interval_orders(int count, Random random) const {
        std::vector<int> orders(static_cast<std::size_t>(count));
        switch (design_.interval_order) {
            case IntervalOrder::reference_first:
                return orders;
            case IntervalOrder::reference_second:
                std::fill(orders.begin(), orders.end(), 1);
                return orders;
            case IntervalOrder::random:
                for (int& order : orders) order = static_cast<int>(random.below(2));
                return orders;
            case IntervalOrder::balanced:
                break;
        }
        // Half and half; where the count is odd, chance says which has one more.
        const int extra = static_cast<int>(random.below(2));
        for (std::size_t i = 0; i < orders.size(); ++i) orders[i] = (static_cast<int>(i) + extra) % 2;
        random.shuffle(orders);
        return orders;
    }

    void add_training() {
        std::vector<int> conditions = counted(static_cast<int>(protocol_.conditions.size()));
        stream_for(seed_, participant_, "training conditions").shuffle(conditions);
        assert(design_.training_trials <= static_cast<int>(conditions.size()));
        conditions.resize(static_cast<std::size_t>(design_.training_trials));
        const std::vector<int> orders = interval_orders(
            design_.training_trials, stream_for(seed_, participant_, "training interval orders"));
        for (std::size_t i = 0; i < conditions.size(); ++i)
            add(0, 0, TrialKind::training, {conditions[i], scene_of_session(1)}, orders[i]);
    }

    // The order of the items in one block; blocks are counted over all sessions.
    std::vector<int> order_of_block(int items, int block, int blocks) const {
        std::vector<int> order = counted(items);
        if (design_.condition_order == ConditionOrder::listed) return order;
        if (design_.condition_order == ConditionOrder::shuffled) {
            stream_for(seed_, participant_, "order of block " + std::to_string(block)).shuffle(order);
            return order;
        }
        // A relabelling shared by all participants hides the square's regular steps and keeps its balance. A
        // participant's blocks take rows that lie evenly apart, so that every block is balanced over
        // participants by itself.
        const std::vector<std::vector<int>> square = williams_square(items);
        const int rows = static_cast<int>(square.size());
        const int row = (participant_ + block * std::max(1, rows / blocks)) % rows;
        std::vector<int> labels = counted(items);
        Random::stream(design_.label_seed, "labels of the Williams square").shuffle(labels);
        for (std::size_t i = 0; i < order.size(); ++i)
            order[i] = labels[static_cast<std::size_t>(square[static_cast<std::size_t>(row)][i])];
        return order;
    }

    // Which interval shows the reference for each item and repetition of a session. Balanced sessions come in
    // pairs: the second of a pair shows every item the other way round.
    std::vector<int> orders_of_session(int session, int count) const {
        const bool second_of_pair = design_.interval_order == IntervalOrder::balanced && session % 2 == 0;
        const int drawn = second_of_pair ? session - 1 : session;
        std::vector<int> orders = interval_orders(
            count, stream_for(seed_, participant_, "interval orders of session " + std::to_string(drawn)));
        if (second_of_pair)
            for (int& order : orders) order = 1 - order;
        return orders;
    }

    void add_session(int session) {
        const std::vector<Item> items = items_of_session(session);
        const int item_count = static_cast<int>(items.size());
        const int condition_trials = item_count * design_.repetitions;
        const int validation_trials = protocol_.validation_per_session();

        // Choose the places of the validation trials: any set of places is as likely as any other.
        std::vector<int> places = counted(condition_trials + validation_trials);
        Random random =
            stream_for(seed_, participant_, "validation places of session " + std::to_string(session));
        random.shuffle(places);
        std::vector<bool> validates(places.size());
        for (int i = 0; i < validation_trials; ++i)
            validates[static_cast<std::size_t>(places[static_cast<std::size_t>(i)])] = true;

        // Choose scenes and interval orders of the validation trials.
        std::vector<std::string> scenes;
        for (int i = 0; i < validation_trials; ++i)
            scenes.push_back(design_.scene_use == SceneUse::crossed
                                 ? protocol_.scenes[static_cast<std::size_t>(i % scene_count())]
                                 : scene_of_session(session));
        random.shuffle(scenes);

        // Order the conditions, block after block.
        const int blocks = design_.sessions * design_.repetitions;
        std::vector<std::pair<int, int>> sequence;  // block, item
        for (int block = 0; block < design_.repetitions; ++block)
            for (const int item :
                 order_of_block(item_count, (session - 1) * design_.repetitions + block, blocks))
                sequence.emplace_back(block, item);
        const std::vector<int> orders = orders_of_session(session, condition_trials);

        // Weave the two together.
        std::size_t next = 0, next_validation = 0;
        for (const bool validation : validates) {
            const auto [block, item] = sequence[std::min(next, sequence.size() - 1)];
            if (validation) {
                add(session, block, TrialKind::validation, {-1, scenes[next_validation++]}, 0);
            } else {
                const std::size_t order = static_cast<std::size_t>(block * item_count + item);
                add(session, block, TrialKind::condition, items[static_cast<std::size_t>(item)],
                    orders[order]);
                ++next;
            }
        }
    }

    const Protocol& protocol_;
    const Design& design_;
    int participant_;
    std::uint64_t seed_;
    TrialPlan plan_;
};

std::string csv_field(const std::string& text) {
    if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
    return quoted + '"';
}

std::string parameter_text(const MethodSetting& setting, const std::string& name) {
    if (name == "method") return setting.method;
    if (const auto word = setting.words.find(name); word != setting.words.end()) return word->second;
    const auto number = setting.numbers.find(name);
    if (number == setting.numbers.end()) return "";
    char buffer[32];
    return std::string(buffer, std::to_chars(buffer, buffer + sizeof buffer, number->second).ptr);
}

}  // namespace

TrialPlan make_plan(const Protocol& protocol, int participant_index, std::uint64_t seed) {
    assert(participant_index >= 0 && !protocol.scenes.empty() && !protocol.conditions.empty());
    return Planner(protocol, participant_index, seed).make();
}

std::string_view kind_name(TrialKind kind) {
    switch (kind) {
        case TrialKind::training:
            return "training";
        case TrialKind::condition:
            return "condition";
        case TrialKind::validation:
            return "validation";
    }
    return "unknown";
}

void write_plan_csv(std::ostream& out, const TrialPlan& plan, const Protocol& protocol) {
    out << "trial,session,block,position,kind,condition,scene,reference_interval,first,second";
    for (const std::string& factor : protocol.factors) out << ',' << csv_field(factor);
    out << '\n';
    for (const PlannedTrial& trial : plan.trials) {
        out << trial.number << ',' << trial.session << ',' << trial.block << ',' << trial.position << ','
            << kind_name(trial.kind) << ',' << (trial.condition < 0 ? "" : std::to_string(trial.condition))
            << ',' << csv_field(trial.scene) << ','
            << (trial.kind == TrialKind::validation ? "" : std::to_string(trial.reference_interval)) << ','
            << csv_field(to_text(trial.first)) << ',' << csv_field(to_text(trial.second));
        for (const std::string& factor : protocol.factors)
            out << ','
                << (trial.condition < 0
                        ? ""
                        : csv_field(parameter_text(
                              protocol.conditions[static_cast<std::size_t>(trial.condition)], factor)));
        out << '\n';
    }
}

}  // namespace parafovea
