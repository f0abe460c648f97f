// The Open Gaze protocol of Gazepoint trackers: one XML-like element a line. Text in, values out.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "devices/geometry.h"

namespace parafovea {

// <REC CNT="1" TIME="0.5" />: a name and its attributes.
struct OpenGazeMessage {
    std::string name;
    std::vector<std::pair<std::string, std::string>> attributes;

    // Empty if there is no such attribute.
    std::string_view text(std::string_view attribute) const;
    // Nothing if there is no such attribute or it is not a finite number.
    std::optional<double> number(std::string_view attribute) const;
};

// Nothing for a line that is not one complete element.
std::optional<OpenGazeMessage> parse_open_gaze(std::string_view line);

// A point on the screen as fractions of its width and height from the top left.
struct ScreenFraction {
    double x = 0, y = 0;
};

struct OpenGazeRecord {
    std::optional<std::int64_t> count;                // the tracker's frame counter
    std::optional<double> time_s;                     // on the tracker's clock
    std::optional<ScreenFraction> best, left, right;  // absent where the tracker calls them invalid
    std::optional<double> left_pupil_mm, right_pupil_mm;
};

// Nothing unless the message is a REC.
std::optional<OpenGazeRecord> decode_open_gaze_record(const OpenGazeMessage& message);

// Cuts a byte stream into lines. A line longer than 64 KiB is thrown away.
class LineSplitter {
  public:
    // Returns the lines that these bytes complete, without their ends.
    std::vector<std::string> feed(std::string_view bytes);

  private:
    std::string rest_;
    bool skipping_ = false;
};

}  // namespace parafovea
