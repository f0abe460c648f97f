// Takes stock of many session files before they are analysed together: which to use, and what is wrong with
// the others.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace parafovea {

// What identifies one session in one file.
struct SessionStamp {
    std::string file;
    std::string session_id;  // unique over all sites; empty when the file has none
    std::string participant;
    int session = 1;
    std::string site;
    std::string protocol_name;
    std::string protocol_hash;
    std::int64_t answers = 0;
};

enum class InventoryFinding {
    duplicate_session,  // one session_id in several files: the one with most answers is used
    same_number,  // different sessions of one participant and site under one number: all are used, look at
                  // them
    shared_name,  // one participant identifier at several sites: not taken for one person; rename at one site
    other_protocol,  // not the protocol of most sessions: left out
    empty_session    // no answer: left out
};

struct InventoryProblem {
    InventoryFinding finding = InventoryFinding::duplicate_session;
    std::vector<std::size_t> sessions;  // indices of the stamps it is about
    std::string text;                   // one line that names the files
};

struct Inventory {
    std::vector<std::size_t> usable;  // indices of the stamps to analyse, in their order
    std::vector<InventoryProblem> problems;
    std::string protocol_hash;  // of the usable ones
};

Inventory take_inventory(std::span<const SessionStamp> stamps);

}  // namespace parafovea
