#include "solver/time/interruption.hpp"

#include <atomic>
#include <csignal>

namespace slurry {
namespace {

// A signal's handler knows nothing but what is global.
std::atomic<int> received{0};
static_assert(std::atomic<int>::is_always_lock_free, "or a handler may not write it");

int alive = 0; // of the Interruptions, one inside another

void note(int signal) {
    received = signal;
}

void handle(int signal) {
    struct sigaction now {};
    if (::sigaction(signal, nullptr, &now) != 0 || now.sa_handler == SIG_IGN) {
        return;
    }
    struct sigaction noting {};
    noting.sa_handler = note;
    noting.sa_flags = static_cast<int>(SA_RESETHAND) | SA_RESTART;
    ::sigaction(signal, &noting, nullptr);
}

void handle_no_more(int signal) {
    struct sigaction now {};
    if (::sigaction(signal, nullptr, &now) == 0 && now.sa_handler == note) {
        std::signal(signal, SIG_DFL);
    }
}

} // namespace

Interruption::Interruption() {
    if (alive++ == 0) {
        received = 0;
        handle(SIGTERM);
        handle(SIGINT);
    }
}

Interruption::~Interruption() {
    if (--alive == 0) {
        handle_no_more(SIGTERM);
        handle_no_more(SIGINT);
    }
}

const char* Interruption::signal_name() {
    switch (received.load(std::memory_order_relaxed)) {
    case 0:
        return nullptr;
    case SIGINT:
        return "SIGINT";
    default:
        return "SIGTERM";
    }
}

} // namespace slurry
