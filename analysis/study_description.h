// What the analysis must be told about a study so that its figures and reports name it truthfully.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace parafovea {

struct StudyDescription {
    std::string title = "Visual identity of foveated and full-resolution pictures";
    std::string data_origin;  // empty for people; otherwise what every reader must see, such as "simulated
                              // participants"
    bool is_pilot = false;    // the figure is then Figure 9 instead of Figure 10
    std::string protocol_name;
    std::string protocol_hash;
    std::string program_version;
    std::vector<std::pair<std::string, std::string>>
        provenance;                       // further "label, value" pairs, such as seeds and devices
    double identical_criterion = 0.8;     // P_I that a setting must reach to be accepted
    double non_inferiority_margin = 0.1;  // below the criterion, fixed before the data were seen
    int planned_participants = 0;         // fixed before the data were seen; 0 when it was not
    std::string exclusion_rules;          // the rules in words, as stored before the first session
    std::string exclusion_rules_hash;
    bool overdispersion = false;      // psychometric fits allow answers to vary more than independent ones do
    std::uint64_t analysis_seed = 1;  // of permutations and bootstraps
};

}  // namespace parafovea
