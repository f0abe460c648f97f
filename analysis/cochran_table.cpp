// Table 1: Cochran's Q across alpha for every sigma.
#include "analysis/cochran_table.h"

#include <algorithm>
#include <array>

#include "analysis/number_text.h"
#include "analysis/parallel.h"

namespace parafovea {
namespace {

constexpr double kLevel = 0.05;

std::string q_text(const std::optional<double>& q) {
    return q ? fixed_text(*q, 2) : "n/a";
}

std::string exact_text(const CochranQ& q) {
    return p_text(q.p_exact) + (q.exact_method == ExactMethod::monte_carlo ? "*" : "");
}

// The cells that readers see, the same in Markdown and in a terminal.
std::vector<std::array<std::string, 9>> readable_cells(const CochranTable& table) {
    std::vector<std::array<std::string, 9>> cells;
    for (const CochranRow& row : table.rows) {
        const bool beyond = row.q.q && *row.q.q > chi_square_critical_value(row.q.df, kLevel);
        cells.push_back({short_text(row.sigma), fixed_text(row.sigma * row.sigma, 2),
                         std::to_string(row.q.informative_rows) + " of " + std::to_string(row.q.rows),
                         q_text(row.q.q), std::to_string(row.q.df), p_text(row.q.p_chi2, row.q.log10_p),
                         exact_text(row.q), p_text(row.permutation.p), beyond ? "yes" : "no"});
    }
    return cells;
}

std::vector<std::string> notes(const CochranTable& table) {
    std::vector<std::string> lines{block_statement(table)};
    bool drawn = false, uniform = false;
    std::vector<int> dfs;
    for (const CochranRow& row : table.rows) {
        drawn = drawn || row.q.exact_method == ExactMethod::monte_carlo;
        uniform = uniform || !row.q.q;
        if (std::find(dfs.begin(), dfs.end(), row.q.df) == dfs.end()) dfs.push_back(row.q.df);
    }
    if (table.rows.empty()) return lines;  // what follows explains columns of values
    std::string critical = "Q is beyond its critical value where it exceeds";
    for (std::size_t i = 0; i < dfs.size(); ++i)
        critical += std::string(i ? "," : "") + " chi2(" + std::to_string(dfs[i]) +
                    ") = " + fixed_text(chi_square_critical_value(dfs[i], kLevel), 2);
    lines.push_back(critical + " (p < 0.05).");
    lines.push_back(
        "p exact: all arrangements of the answers within blocks. p within participants: condition labels "
        "shuffled within "
        "whole participants, which keeps its level when people differ in what they notice.");
    if (drawn)
        lines.push_back("*: arrangements drawn instead of counted; the standard error is in table1.csv.");
    if (uniform)
        lines.push_back(
            "n/a: no informative block (every block all identical or all different), so Q is undefined; p "
            "exact = 1.");
    return lines;
}

const std::array<std::string, 9> kHeads{"sigma",
                                        "sigma^2",
                                        "informative blocks",
                                        "Q",
                                        "df",
                                        "p chi2",
                                        "p exact",
                                        "p within participants",
                                        "beyond critical value"};

// Columns on a terminal: characters, not bytes.
std::size_t width_of(const std::string& text) {
    return static_cast<std::size_t>(std::count_if(
        text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0u) != 0x80u; }));
}

}  // namespace

CochranTable cochran_table(const Tally& tally, std::uint64_t seed) {
    CochranTable table;
    table.participants = static_cast<std::int64_t>(tally.participants().size());
    std::vector<std::optional<CochranRow>> rows(tally.sigmas().size());
    parallel_for(rows.size(), [&](std::size_t i) {
        const double sigma = tally.sigmas()[i];
        const BlockTable blocks = tally.blocks(sigma, BlockKind::participant_session);
        if (blocks.alphas.size() < 2) return;
        CochranQOptions options;
        options.seed = seed;
        CochranRow row;
        row.sigma = sigma;
        row.alphas = blocks.alphas;
        row.q = cochran_q(blocks.table, options);
        row.by_participant = cochran_q(tally.blocks(sigma, BlockKind::participant).table, options);
        // Fewer permutations for very many participants; the report gives the standard error.
        const auto cells =
            static_cast<std::int64_t>(std::max<std::size_t>(blocks.participant_sums.size(), 1));
        row.permutation =
            permute_within_participants(blocks.participant_sums, blocks.alphas.size(),
                                        std::clamp<std::int64_t>(8'000'000 / cells, 1'999, 19'999), seed);
        row.incomplete_blocks = blocks.incomplete_blocks;
        row.repeated_blocks = blocks.repeated_blocks;
        rows[i] = std::move(row);
    });
    for (auto& row : rows)
        if (row) table.rows.push_back(std::move(*row));
    return table;
}

std::string block_statement(const CochranTable& table) {
    std::int64_t most = 0, least = INT64_MAX, incomplete = 0, repeated = 0;
    for (const CochranRow& row : table.rows) {
        most = std::max(most, row.q.rows);
        least = std::min(least, row.q.rows);
        incomplete += row.incomplete_blocks;
        repeated += row.repeated_blocks;
    }
    if (table.rows.empty())
        return "No sigma was shown with two or more values of alpha, so there is nothing to compare.";
    std::string text =
        "Blocks are participants x sessions (" + std::to_string(table.participants) + " participants, ";
    text += (least == most ? std::to_string(most) : std::to_string(least) + " to " + std::to_string(most)) +
            " blocks).";
    if (repeated > 0)
        text += " A condition shown several times in a session gives one block per repetition (" +
                std::to_string(repeated) + " further blocks).";
    if (incomplete > 0)
        text += " " + std::to_string(incomplete) +
                " incomplete blocks (an answer missing in some condition) were left out whole.";
    return text;
}

std::string cochran_csv(const CochranTable& table) {
    std::string csv =
        "sigma,sigma2,blocks,informative_blocks,q,df,p_chi2,p_exact,p_permutation,log10_p_chi2,p_mid,exact_"
        "method,exact_se,"
        "permutation_se,incomplete_blocks,q_participants,p_exact_participants\n";
    for (const CochranRow& row : table.rows) {
        const char* method = row.q.exact_method == ExactMethod::enumeration   ? "enumeration"
                             : row.q.exact_method == ExactMethod::monte_carlo ? "monte_carlo"
                                                                              : "none";
        csv += short_text(row.sigma) + "," + general_text(row.sigma * row.sigma, 9) + "," +
               std::to_string(row.q.rows) + "," + std::to_string(row.q.informative_rows) + "," +
               csv_text(row.q.q) + "," + std::to_string(row.q.df) + "," + csv_text(row.q.p_chi2) + "," +
               csv_text(row.q.p_exact) + "," + csv_text(row.permutation.p) + "," + csv_text(row.q.log10_p) +
               "," + csv_text(row.q.p_mid) + "," + method + "," + csv_text(row.q.exact_standard_error) + "," +
               csv_text(row.permutation.standard_error) + "," + std::to_string(row.incomplete_blocks) + "," +
               csv_text(row.by_participant.q) + "," + csv_text(row.by_participant.p_exact) + "\n";
    }
    return csv;
}

std::string cochran_markdown(const CochranTable& table, const std::string& title,
                             const std::string& data_origin) {
    std::string text = "# Table 1. Cochran's Q across alpha, per sigma\n\n" + title + "\n";
    if (!data_origin.empty()) text += "\n**Data: " + data_origin + ".**\n";
    text += "\n|";
    for (const std::string& head : kHeads) text += " " + head + " |";
    text += "\n|";
    for (std::size_t i = 0; i < kHeads.size(); ++i) text += "---:|";
    text += "\n";
    for (const auto& row : readable_cells(table)) {
        text += "|";
        for (const std::string& cell : row) text += " " + cell + " |";
        text += "\n";
    }
    for (const std::string& note : notes(table)) text += "\n" + note + "\n";
    return text;
}

std::string cochran_text(const CochranTable& table, const std::string& title,
                         const std::string& data_origin) {
    std::string text = "Table 1. Cochran's Q across alpha, per sigma\n" + title + "\n";
    if (!data_origin.empty()) text += "Data: " + data_origin + ".\n";
    text += "\n";
    const auto cells = readable_cells(table);
    std::array<std::size_t, 9> width{};
    for (std::size_t i = 0; i < width.size(); ++i) {
        width[i] = kHeads[i].size();
        for (const auto& row : cells) width[i] = std::max(width[i], width_of(row[i]));
    }
    const auto line = [&](const std::array<std::string, 9>& row) {
        for (std::size_t i = 0; i < row.size(); ++i)
            text += std::string(width[i] - width_of(row[i]) + (i ? 2 : 0), ' ') + row[i];
        text += "\n";
    };
    line(kHeads);
    for (const auto& row : cells) line(row);
    text += "\n";
    for (const std::string& note : notes(table)) text += note + "\n";
    return text;
}

}  // namespace parafovea
