#pragma once

namespace slurry {

// While it lives, the first SIGTERM or SIGINT is noted instead of ending the process, so that the run can
// write a checkpoint; the second one of its kind ends it. A signal that is ignored stays so. Inside another
// one it changes nothing: a signal that came at the end of one of several runs is still known in the next.
class Interruption {
  public:
    Interruption();
    ~Interruption();
    Interruption(const Interruption&) = delete;
    Interruption& operator=(const Interruption&) = delete;

    // Name of the signal that came, nullptr if none did.
    [[nodiscard]] static const char* signal_name();
};

} // namespace slurry
