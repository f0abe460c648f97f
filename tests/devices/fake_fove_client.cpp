// A stand-in for FOVE's client library: 120 frames a second of a known gaze, with a blink, low accuracy,
// losses and dropped frames at known frame numbers. FAKE_FOVE_MAJOR sets the version it claims,
// FAKE_FOVE_SERVICE=off its service.
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <thread>

namespace {

struct Headset {
    std::uint64_t id = 1000;
    std::chrono::steady_clock::time_point next = std::chrono::steady_clock::now();
    std::uint64_t timestamp_us = 5'000'000;
    std::atomic<int> calibration = 0;
};

struct Vec3 {
    float x, y, z;
};

constexpr int kNone = 0, kNotConnected = 7, kUnreliable = 1006, kLowAccuracy = 1007;

int quality(const Headset* headset) {
    switch (headset->id % 40) {
        case 10:
            return kLowAccuracy;
        case 15:
            return kUnreliable;
        default:
            return kNone;
    }
}

}  // namespace

extern "C" {

int fove_createHeadset(int, Headset** out) {
    *out = new Headset;
    return kNone;
}
int fove_Headset_destroy(Headset* headset) {
    delete headset;
    return kNone;
}
int fove_Headset_querySoftwareVersions(Headset*, void* out) {
    const char* service = std::getenv("FAKE_FOVE_SERVICE");
    if (service && std::strcmp(service, "off") == 0) return kNotConnected;
    const char* major = std::getenv("FAKE_FOVE_MAJOR");
    // client major, minor, build, year, month, day, protocol, 64 bytes, then the same of the runtime without
    // protocol.
    const int client[7] = {major ? std::atoi(major) : 1, 4, 0, 2025, 8, 1, 1};
    const int runtime[6] = {1, 4, 2, 2025, 8, 2};
    const int firmware[3] = {30, 40, 20};
    char* bytes = static_cast<char*>(out);
    std::memcpy(bytes, client, sizeof client);
    std::memcpy(bytes + 28 + 64, runtime, sizeof runtime);
    std::memcpy(bytes + 28 + 64 + 24 + 64, firmware, sizeof firmware);
    return kNone;
}
int fove_Headset_waitForProcessedEyeFrame(Headset* headset) {
    headset->next += std::chrono::microseconds(8333);
    std::this_thread::sleep_until(headset->next);
    headset->id += headset->id % 40 == 30 ? 3 : 1;  // two frames dropped
    headset->timestamp_us += 8333;
    return kNone;
}
int fove_Headset_fetchEyeTrackingData(Headset* headset, std::uint64_t* frame) {
    frame[0] = headset->id;
    frame[1] = headset->timestamp_us;
    return kNone;
}
int fove_Headset_getGazeVectorRaw(Headset* headset, int eye, Vec3* out) {
    *out = {eye == 0 ? 0.5f : 0.4f, 0.0f, 0.8f};
    return quality(headset);
}
int fove_Headset_getCombinedGazeRay(Headset* headset, Vec3* out) {
    out[0] = {0, 0, 0};
    out[1] = {0.5f, 0.0f, 0.8660254f};
    return quality(headset);
}
int fove_Headset_getEyeState(Headset* headset, int, int* state) {
    *state = headset->id % 40 >= 20 && headset->id % 40 < 25 ? 2 : 1;
    return kNone;
}
int fove_Headset_getPupilRadius(Headset*, int eye, float* metres) {
    *metres = eye == 0 ? 0.002f : 0.0021f;
    return kNone;
}
int fove_Headset_startEyeTrackingCalibration(Headset* headset, const void*) {
    headset->calibration = 3;
    return kNone;
}
int fove_Headset_getEyeTrackingCalibrationState(Headset* headset, int* state) {
    *state = headset->calibration;
    if (headset->calibration == 3) headset->calibration = 5;
    return kNone;
}

}  // extern "C"
