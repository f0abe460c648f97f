// Splits a scene's preparation over the processors.
#pragma once

#include <functional>

namespace parafovea {

// Calls work(i) once for every i below count, from as many threads as there are processors; returns when all
// are done. The work gives the same whatever the order. Where it throws, what has not been begun is left out
// and the exception of the lowest i is thrown again here: the same one every time.
void on_all_processors(int count, const std::function<void(int)>& work);

}  // namespace parafovea
