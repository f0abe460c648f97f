// Takes stock of many session files before they are analysed together: which to use, and what is wrong with
// the others.
#include "analysis/inventory.h"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

namespace parafovea {

Inventory take_inventory(std::span<const SessionStamp> stamps) {
    Inventory inventory;
    std::vector<bool> use(stamps.size(), true);
    const auto names = [&](const std::vector<std::size_t>& sessions) {
        std::string text;
        for (std::size_t i = 0; i < sessions.size() && i < 6; ++i)
            text += (i ? ", " : "") + stamps[sessions[i]].file;
        if (sessions.size() > 6) text += " and " + std::to_string(sessions.size() - 6) + " more";
        return text;
    };

    // Leave out what holds nothing.
    for (std::size_t i = 0; i < stamps.size(); ++i) {
        if (stamps[i].answers > 0) continue;
        use[i] = false;
        inventory.problems.push_back(
            {InventoryFinding::empty_session, {i}, stamps[i].file + ": holds no answer and is left out"});
    }

    // Of the copies of a session keep the fullest, the first of equals.
    std::map<std::string, std::vector<std::size_t>> copies;
    for (std::size_t i = 0; i < stamps.size(); ++i)
        if (use[i] && !stamps[i].session_id.empty()) copies[stamps[i].session_id].push_back(i);
    for (const auto& [id, sessions] : copies) {
        if (sessions.size() < 2) continue;
        std::size_t best = sessions.front();
        for (std::size_t i : sessions)
            if (stamps[i].answers > stamps[best].answers) best = i;
        for (std::size_t i : sessions) use[i] = i == best;
        inventory.problems.push_back({InventoryFinding::duplicate_session, sessions,
                                      "session " + id + " of participant " + stamps[best].participant +
                                          " is in " + std::to_string(sessions.size()) + " files (" +
                                          names(sessions) + "); only " + stamps[best].file + " is used"});
    }

    // The protocol is that of most sessions; ties go to the one seen first.
    std::map<std::string, std::vector<std::size_t>> protocols;
    for (std::size_t i = 0; i < stamps.size(); ++i)
        if (use[i]) protocols[stamps[i].protocol_hash].push_back(i);
    const std::vector<std::size_t>* main = nullptr;
    for (const auto& [hash, sessions] : protocols)
        if (!main || sessions.size() > main->size() ||
            (sessions.size() == main->size() && sessions.front() < main->front()))
            main = &sessions;
    if (main) inventory.protocol_hash = stamps[main->front()].protocol_hash;
    for (const auto& [hash, sessions] : protocols) {
        if (&sessions == main) continue;
        for (std::size_t i : sessions) use[i] = false;
        const SessionStamp& first = stamps[sessions.front()];
        inventory.problems.push_back(
            {InventoryFinding::other_protocol, sessions,
             names(sessions) + ": protocol '" + first.protocol_name + "' (hash " +
                 (hash.empty() ? "none" : hash) + ") is not that of most sessions, '" +
                 stamps[main->front()].protocol_name + "' (hash " + inventory.protocol_hash + "); left out"});
    }

    // Numbers and names that two sessions or two people share.
    std::map<std::tuple<std::string, std::string, int>, std::vector<std::size_t>> numbers;
    std::map<std::string, std::map<std::string, std::vector<std::size_t>>> sites;
    for (std::size_t i = 0; i < stamps.size(); ++i) {
        if (!use[i]) continue;
        numbers[{stamps[i].site, stamps[i].participant, stamps[i].session}].push_back(i);
        sites[stamps[i].participant][stamps[i].site].push_back(i);
        inventory.usable.push_back(i);
    }
    for (const auto& [key, sessions] : numbers)
        if (sessions.size() > 1)
            inventory.problems.push_back(
                {InventoryFinding::same_number, sessions,
                 "participant " + std::get<1>(key) + " has " + std::to_string(sessions.size()) +
                     " different sessions numbered " + std::to_string(std::get<2>(key)) + " (" +
                     names(sessions) + "); all are used"});
    for (const auto& [participant, places] : sites) {
        if (places.size() < 2) continue;
        std::vector<std::size_t> sessions;
        for (const auto& [site, at] : places) sessions.insert(sessions.end(), at.begin(), at.end());
        inventory.problems.push_back({InventoryFinding::shared_name, sessions,
                                      "participant " + participant + " is at " +
                                          std::to_string(places.size()) + " sites (" + names(sessions) +
                                          "); kept apart as different people"});
    }
    return inventory;
}

}  // namespace parafovea
