// Taking stock of many session files: duplicates, other protocols, shared names.
#include "analysis/inventory.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace parafovea {
namespace {

SessionStamp stamp(const std::string& file, const std::string& id, const std::string& participant,
                   int session) {
    return {file, id, participant, session, "", "final", "hash1", 40};
}

TEST(Inventory, of_sound_sessions_uses_all_and_finds_nothing) {
    const std::vector<SessionStamp> stamps{stamp("a", "1", "P01", 1), stamp("b", "2", "P01", 2),
                                           stamp("c", "3", "P02", 1)};
    const Inventory inventory = take_inventory(stamps);
    EXPECT_EQ(inventory.usable, (std::vector<std::size_t>{0, 1, 2}));
    EXPECT_TRUE(inventory.problems.empty());
    EXPECT_EQ(inventory.protocol_hash, "hash1");
    EXPECT_TRUE(take_inventory({}).usable.empty());
}

TEST(Inventory, names_copies_and_uses_the_fullest) {
    std::vector<SessionStamp> stamps{stamp("a.sqlite", "1", "P01", 1), stamp("copy.sqlite", "1", "P01", 1)};
    stamps[0].answers = 12;
    const Inventory inventory = take_inventory(stamps);
    EXPECT_EQ(inventory.usable, (std::vector<std::size_t>{1}));
    ASSERT_EQ(inventory.problems.size(), 1u);
    EXPECT_EQ(inventory.problems[0].finding, InventoryFinding::duplicate_session);
    EXPECT_NE(inventory.problems[0].text.find("a.sqlite, copy.sqlite"), std::string::npos);
    EXPECT_NE(inventory.problems[0].text.find("only copy.sqlite is used"), std::string::npos);
}

TEST(Inventory, leaves_out_and_names_other_protocols_and_empty_sessions) {
    std::vector<SessionStamp> stamps;
    for (int i = 0; i < 5; ++i)
        stamps.push_back(stamp("f" + std::to_string(i), std::to_string(i), "P" + std::to_string(i), 1));
    stamps[2].protocol_hash = "hash2";
    stamps[2].protocol_name = "pilot";
    stamps[4].answers = 0;
    const Inventory inventory = take_inventory(stamps);
    EXPECT_EQ(inventory.usable, (std::vector<std::size_t>{0, 1, 3}));
    ASSERT_EQ(inventory.problems.size(), 2u);
    EXPECT_NE(inventory.problems[0].text.find("f4"), std::string::npos);
    EXPECT_EQ(inventory.problems[1].finding, InventoryFinding::other_protocol);
    EXPECT_NE(inventory.problems[1].text.find("f2: protocol 'pilot' (hash hash2)"), std::string::npos);
}

TEST(Inventory, names_shared_session_numbers_and_people_of_one_name_at_two_sites) {
    std::vector<SessionStamp> stamps{stamp("a", "1", "P01", 1), stamp("b", "2", "P01", 1),
                                     stamp("c", "3", "P01", 1)};
    stamps[2].site = "Graz";
    const Inventory inventory = take_inventory(stamps);
    EXPECT_EQ(inventory.usable.size(), 3u);
    ASSERT_EQ(inventory.problems.size(), 2u);
    EXPECT_EQ(inventory.problems[0].finding, InventoryFinding::same_number);
    EXPECT_EQ(inventory.problems[1].finding, InventoryFinding::shared_name);
}

}  // namespace
}  // namespace parafovea
