// A study as data: everything a TOML protocol says.
#pragma once

#include "study/method_setting.h"
