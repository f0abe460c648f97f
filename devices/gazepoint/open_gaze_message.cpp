// A parser for the elements Open Gaze sends; it accepts nothing nested.
#include "devices/gazepoint/open_gaze_message.h"

#include <charconv>
#include <cmath>

namespace parafovea {
namespace {

constexpr std::size_t kLongestLine = 65536;

bool is_space(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}
bool is_name(char c) {
    return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
}

class Cursor {
  public:
    explicit Cursor(std::string_view text) : text_(text) {}

    void skip_spaces() {
        while (!text_.empty() && is_space(text_.front())) text_.remove_prefix(1);
    }
    bool take(char c) {
        if (text_.empty() || text_.front() != c) return false;
        text_.remove_prefix(1);
        return true;
    }
    std::string_view name() { return while_true(is_name); }
    std::string_view until(char end) {
        return while_true([end](char c) { return c != end; });
    }
    bool at_end() const { return text_.empty(); }

  private:
    template <typename Condition>
    std::string_view while_true(Condition condition) {
        std::size_t n = 0;
        while (n < text_.size() && condition(text_[n])) ++n;
        const std::string_view taken = text_.substr(0, n);
        text_.remove_prefix(n);
        return taken;
    }

    std::string_view text_;
};

std::optional<ScreenFraction> point(const OpenGazeMessage& m, const char* x, const char* y,
                                    const char* valid) {
    const auto px = m.number(x), py = m.number(y), ok = m.number(valid);
    if (!px || !py || !ok || *ok == 0) return std::nullopt;
    return ScreenFraction{*px, *py};
}

std::optional<double> pupil_mm(const OpenGazeMessage& m, const char* diameter_m, const char* valid) {
    const auto size = m.number(diameter_m), ok = m.number(valid);
    if (!size || !ok || *ok == 0) return std::nullopt;
    return *size * 1000;
}

}  // namespace

std::string_view OpenGazeMessage::text(std::string_view attribute) const {
    for (const auto& [name_of, value] : attributes)
        if (name_of == attribute) return value;
    return {};
}

std::optional<double> OpenGazeMessage::number(std::string_view attribute) const {
    const std::string_view value = text(attribute);
    double result = 0;
    const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), result);
    if (value.empty() || error != std::errc() || end != value.data() + value.size() || !std::isfinite(result))
        return std::nullopt;
    return result;
}

std::optional<OpenGazeMessage> parse_open_gaze(std::string_view line) {
    Cursor at(line);
    OpenGazeMessage message;
    at.skip_spaces();
    if (!at.take('<')) return std::nullopt;
    message.name = at.name();
    if (message.name.empty()) return std::nullopt;
    for (;;) {
        at.skip_spaces();
        if (at.take('/')) {
            if (!at.take('>')) return std::nullopt;
            at.skip_spaces();
            if (!at.at_end()) return std::nullopt;
            return message;
        }
        std::string attribute(at.name());
        if (attribute.empty() || !at.take('=') || !at.take('"')) return std::nullopt;
        std::string value(at.until('"'));
        if (!at.take('"')) return std::nullopt;
        message.attributes.emplace_back(std::move(attribute), std::move(value));
    }
}

std::optional<OpenGazeRecord> decode_open_gaze_record(const OpenGazeMessage& message) {
    if (message.name != "REC") return std::nullopt;
    OpenGazeRecord record;
    if (const auto count = message.number("CNT"); count && std::abs(*count) < 1e15)
        record.count = std::llround(*count);
    record.time_s = message.number("TIME");
    if (record.time_s && std::abs(*record.time_s) > 1e9) record.time_s.reset();
    record.best = point(message, "BPOGX", "BPOGY", "BPOGV");
    record.left = point(message, "LPOGX", "LPOGY", "LPOGV");
    record.right = point(message, "RPOGX", "RPOGY", "RPOGV");
    record.left_pupil_mm = pupil_mm(message, "LPUPILD", "LPUPILV");
    record.right_pupil_mm = pupil_mm(message, "RPUPILD", "RPUPILV");
    return record;
}

std::vector<std::string> LineSplitter::feed(std::string_view bytes) {
    std::vector<std::string> lines;
    for (const char c : bytes) {
        if (c == '\n') {
            if (!skipping_) {
                if (!rest_.empty() && rest_.back() == '\r') rest_.pop_back();
                lines.push_back(std::move(rest_));
            }
            rest_.clear();
            skipping_ = false;
        } else if (!skipping_) {
            rest_ += c;
            if (rest_.size() > kLongestLine) {
                rest_.clear();
                skipping_ = true;
            }
        }
    }
    return lines;
}

}  // namespace parafovea
