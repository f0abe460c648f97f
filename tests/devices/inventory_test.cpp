// The inventory names every source, and says what to do about each that is missing.
#include "devices/inventory.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>

namespace parafovea {
namespace {

TEST(Inventory, HasEverySourceAndOneLineOfHelpForWhatIsNotHere) {
    std::set<std::string> sources;
    for (const InventoryItem& item :
         take_inventory({.fove_library = "libNoSuchFove.so", .gazepoint_port = 1})) {
        sources.insert(item.source);
        EXPECT_EQ(item.how.empty(), item.presence == Presence::here) << item.source;
        EXPECT_EQ(item.found.empty(), item.presence == Presence::missing) << item.source;
        EXPECT_EQ(inventory_line(item).find('\n'), std::string::npos);
        EXPECT_THAT(inventory_line(item), testing::HasSubstr(item.source));
        EXPECT_THAT(inventory_line(item),
                    testing::HasSubstr(item.presence == Presence::here ? item.found : item.how));
    }
    EXPECT_THAT(sources, testing::UnorderedElementsAre("hid", "fove", "gazepoint", "simulated", "replay",
                                                       "evdev", "hidapi", "libusb"));
}

TEST(Inventory, FindsTheFoveLibraryWhereThereIsOne) {
    const auto items = take_inventory({.fove_library = PARAFOVEA_FAKE_FOVE, .gazepoint_port = 1});
    const auto fove =
        std::find_if(items.begin(), items.end(), [](const InventoryItem& i) { return i.source == "fove"; });
    ASSERT_NE(fove, items.end());
    EXPECT_EQ(fove->presence, Presence::here);
}

TEST(UdevRules, GiveAccessWithEveryRule) {
    std::ifstream file(PARAFOVEA_SOURCE_DIR "/devices/udev/70-parafovea.rules");
    ASSERT_TRUE(file);
    int rules = 0;
    for (std::string line; std::getline(file, line);) {
        if (line.empty() || line[0] == '#') continue;
        ++rules;
        EXPECT_TRUE(line.ends_with("TAG+=\"uaccess\"")) << line;
        EXPECT_EQ(std::count(line.begin(), line.end(), '"') % 2, 0) << line;
    }
    EXPECT_GE(rules, 6);
}

}  // namespace
}  // namespace parafovea
