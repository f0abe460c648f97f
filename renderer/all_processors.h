// Splits a scene's preparation over the processors.
#pragma once

#include <functional>

namespace parafovea {

// Calls work(i) once for every i below count, from as many threads as there are processors; returns when all
// are done. The work does not throw, and gives the same whatever the order.
void on_all_processors(int count, const std::function<void(int)>& work);

}  // namespace parafovea
