// Table 1: Cochran's Q across alpha for every sigma.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "analysis/tally.h"

namespace parafovea {

struct CochranRow {
    double sigma = 0.0;
    std::vector<double> alphas;
    CochranQ q;                   // rows: participants x sessions
    CochranQ by_participant;      // rows: participants
    PermutationTest permutation;  // within participants
    std::int64_t incomplete_blocks = 0;
    std::int64_t repeated_blocks = 0;
};

struct CochranTable {
    std::vector<CochranRow> rows;  // in rising order of sigma; one row per sigma with at least two alphas
    std::int64_t participants = 0;
};

CochranTable cochran_table(const Tally& tally, std::uint64_t seed);

// One sentence that says what a block is and what was left out.
std::string block_statement(const CochranTable& table);

// CSV: sigma, sigma2, blocks, informative_blocks, q, df, p_chi2, p_exact, p_permutation, then log10_p_chi2,
// p_mid, exact_method, exact_se, permutation_se, incomplete_blocks, q_participants, p_exact_participants.
std::string cochran_csv(const CochranTable& table);
std::string cochran_markdown(const CochranTable& table, const std::string& title,
                             const std::string& data_origin);
std::string cochran_text(const CochranTable& table, const std::string& title, const std::string& data_origin);

}  // namespace parafovea
