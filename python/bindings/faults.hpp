// A plugin that ends Python is named.
#pragma once

namespace rouleau::python {

/// From now on a fatal signal, or the end of the process, in a function of a plugin says whose it was, and what was
/// there before follows: Python's faulthandler, or the end. And a fork leaves no threads behind that the child would
/// wait for.
void prepare_process();

}  // namespace rouleau::python
