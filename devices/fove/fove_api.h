// Our own declarations of the few calls of FOVE's client library (version 1.4) that gaze needs, loaded at run
// time.
#pragma once

#include <cstdint>
#include <string>

namespace parafovea {

// The library's C interface: plain ints for its enumerations, its struct layouts. HMD coordinates: x right, y
// up, z forward, metres.
namespace fove {

struct Headset;

enum Error : int {
    kNone = 0,
    kConnectNotConnected = 7,
    kApiTimeout = 130,
    kDataNoUpdate = 1003,
    kDataUncalibrated = 1004,
    kDataUnreliable = 1006,
    kDataLowAccuracy = 1007,  // the value is written all the same
    kHardwareDisconnected = 2006,
};

enum Capability : int { kEyeTracking = 1 << 3, kPupilRadius = 1 << 14 };
enum Eye : int { kLeft = 0, kRight = 1 };
enum EyeState : int { kNotDetected = 0, kOpened = 1, kClosed = 2 };

struct Vec3 {
    float x, y, z;
};
struct Ray {
    Vec3 origin, direction;
};
struct FrameTimestamp {
    std::uint64_t id, timestamp_us;
};
struct Versions {
    int client_major, client_minor, client_build, client_year, client_month, client_day, client_protocol;
    char client_hash[64];
    int runtime_major, runtime_minor, runtime_build, runtime_year, runtime_month, runtime_day;
    char runtime_hash[64];
    int firmware, max_firmware, min_firmware;
    bool too_old_headset_connected;
};
struct CalibrationOptions {
    bool lazy, restart;
    int eye_by_eye, method, eye_torsion;
};

}  // namespace fove

// The loaded library. Its calls may be made from any one thread at a time.
class FoveLibrary {
  public:
    // Throws std::runtime_error if the library is not installed, lacks a call, or is of a major version whose
    // layout is not known. `path` is a file name for the loader to find, or a path.
    explicit FoveLibrary(const std::string& path);
    ~FoveLibrary();
    FoveLibrary(const FoveLibrary&) = delete;
    FoveLibrary& operator=(const FoveLibrary&) = delete;

    int (*create_headset)(int capabilities, fove::Headset** out) = nullptr;
    int (*destroy)(fove::Headset*) = nullptr;
    int (*query_software_versions)(fove::Headset*, fove::Versions*) = nullptr;
    int (*wait_for_processed_eye_frame)(fove::Headset*) = nullptr;
    int (*fetch_eye_tracking_data)(fove::Headset*, fove::FrameTimestamp*) = nullptr;
    int (*get_gaze_vector_raw)(fove::Headset*, int eye, fove::Vec3*) = nullptr;
    int (*get_combined_gaze_ray)(fove::Headset*, fove::Ray*) = nullptr;
    int (*get_eye_state)(fove::Headset*, int eye, int* state) = nullptr;
    int (*get_pupil_radius)(fove::Headset*, int eye, float* metres) = nullptr;
    int (*start_eye_tracking_calibration)(fove::Headset*, const fove::CalibrationOptions*) = nullptr;
    int (*get_eye_tracking_calibration_state)(fove::Headset*, int* state) = nullptr;

  private:
    void* handle_ = nullptr;
};

// Whether the loader finds the client library.
bool fove_library_installed(const std::string& path = "libFoveClient.so");

}  // namespace parafovea
