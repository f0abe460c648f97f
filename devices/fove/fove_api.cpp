// Loads FOVE's client library and its symbols.
#include "devices/fove/fove_api.h"

#include <dlfcn.h>

#include <stdexcept>

namespace parafovea {
namespace {

template <typename Function>
void load(void* library, const char* name, Function& function) {
    function = reinterpret_cast<Function>(dlsym(library, name));
    if (!function) {
        dlclose(library);
        throw std::runtime_error(std::string("FOVE's client library has no ") + name +
                                 "; install version 1.4 of the FOVE software");
    }
}

}  // namespace

FoveLibrary::FoveLibrary(const std::string& path) {
    handle_ = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!handle_)
        throw std::runtime_error(
            "FOVE's client library " + path +
            " is not installed; install the FOVE software from fove-inc.com and start its service");
    load(handle_, "fove_createHeadset", create_headset);
    load(handle_, "fove_Headset_destroy", destroy);
    load(handle_, "fove_Headset_querySoftwareVersions", query_software_versions);
    load(handle_, "fove_Headset_waitForProcessedEyeFrame", wait_for_processed_eye_frame);
    load(handle_, "fove_Headset_fetchEyeTrackingData", fetch_eye_tracking_data);
    load(handle_, "fove_Headset_getGazeVectorRaw", get_gaze_vector_raw);
    load(handle_, "fove_Headset_getCombinedGazeRay", get_combined_gaze_ray);
    load(handle_, "fove_Headset_getEyeState", get_eye_state);
    load(handle_, "fove_Headset_getPupilRadius", get_pupil_radius);
    load(handle_, "fove_Headset_startEyeTrackingCalibration", start_eye_tracking_calibration);
    load(handle_, "fove_Headset_getEyeTrackingCalibrationState", get_eye_tracking_calibration_state);
}

FoveLibrary::~FoveLibrary() {
    dlclose(handle_);
}

bool fove_library_installed(const std::string& path) {
    void* const handle = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (handle) dlclose(handle);
    return handle != nullptr;
}

}  // namespace parafovea
