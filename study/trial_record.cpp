// A hash over all that a trial left behind.
#include "study/trial_record.h"

#include <bit>

namespace parafovea {
namespace {

class Hash {
  public:
    Hash& add(std::uint64_t value) {
        for (int i = 0; i < 8; ++i) add_byte(static_cast<unsigned char>(value >> (8 * i)));
        return *this;
    }
    Hash& add(std::int64_t value) { return add(static_cast<std::uint64_t>(value)); }
    Hash& add(int value) { return add(static_cast<std::int64_t>(value)); }
    Hash& add(bool value) { return add(value ? 1 : 0); }
    // SQLite keeps no minus zero.
    Hash& add(double value) { return add(std::bit_cast<std::uint64_t>(value + 0.0)); }
    Hash& add(HostTime value) { return add(value.ns); }
    Hash& add(DeviceTime value) { return add(value.ns); }
    Hash& add(Duration value) { return add(value.ns); }
    Hash& add(PointPx value) { return add(value.x).add(value.y); }
    Hash& add(DirectionDeg value) { return add(value.azimuth_deg).add(value.elevation_deg); }
    Hash& add(const EyeSample& value) { return add(value.direction).add(value.pupil_mm); }
    Hash& add(const std::string& value) {
        add(static_cast<std::uint64_t>(value.size()));
        for (const char c : value) add_byte(static_cast<unsigned char>(c));
        return *this;
    }
    template <typename Value>
    Hash& add(const std::optional<Value>& value) {
        add(value.has_value());
        return value ? add(*value) : *this;
    }
    template <typename Value>
    requires std::is_enum_v<Value> Hash& add(Value value) { return add(static_cast<int>(value)); }

    std::uint64_t value() const { return value_; }

  private:
    void add_byte(unsigned char byte) { value_ = (value_ ^ byte) * 0x100000001b3u; }

    std::uint64_t value_ = 0xcbf29ce484222325u;
};

}  // namespace

std::uint64_t content_hash(const TrialRecord& record) {
    Hash hash;
    hash.add(record.planned.number)
        .add(record.attempt)
        .add(record.level)
        .add(record.started)
        .add(record.interrupted);
    for (const IntervalRecord& interval : record.intervals)
        hash.add(interval.phase)
            .add(interval.intended_frames)
            .add(interval.presented_frames)
            .add(interval.first_display)
            .add(interval.last_display)
            .add(interval.end)
            .add(interval.time_source)
            .add(interval.missed_vsyncs)
            .add(interval.longest_frame);
    for (const FrameRecord& frame : record.frames)
        hash.add(frame.phase)
            .add(frame.shown.index)
            .add(frame.shown.display_time)
            .add(frame.shown.time_source)
            .add(frame.shown.missed_vsyncs)
            .add(frame.shown.gpu_time)
            .add(frame.shown.image_hash)
            .add(frame.shown.fault)
            .add(frame.fovea)
            .add(frame.fallback)
            .add(frame.gaze_sequence)
            .add(frame.gaze_age)
            .add(frame.gaze_known)
            .add(frame.events_known);
    for (const GazeSample& sample : record.gaze)
        hash.add(sample.sequence)
            .add(sample.device_time)
            .add(sample.host_time)
            .add(sample.host_time_error)
            .add(sample.arrival_time)
            .add(sample.status)
            .add(sample.direction)
            .add(sample.left)
            .add(sample.right);
    for (const ControllerEvent& event : record.events) {
        const bool of_button =
            event.kind == ControllerEventKind::press || event.kind == ControllerEventKind::release;
        hash.add(event.kind)
            .add(event.time)
            .add(event.time_error)
            .add(of_button ? static_cast<int>(event.button) : -1);
    }
    if (record.answer)
        hash.add(record.answer->identical)
            .add(record.answer->button)
            .add(record.answer->time)
            .add(record.answer->reaction);
    for (const std::string& rule : record.invalid) hash.add(rule);
    return hash.value();
}

}  // namespace parafovea
