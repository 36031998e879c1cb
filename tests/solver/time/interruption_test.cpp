#include "solver/time/interruption.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <string_view>

namespace slurry {
namespace {

TEST(Interruption, NotesASignalInsteadOfEndingTheProcess) {
    for (const int signal : {SIGTERM, SIGINT}) {
        std::signal(signal, SIG_DFL); // a shell's background job ignores SIGINT from the start
        const Interruption interruption;
        EXPECT_EQ(Interruption::signal_name(), nullptr);
        std::raise(signal);
        ASSERT_NE(Interruption::signal_name(), nullptr);
        EXPECT_EQ(std::string_view(Interruption::signal_name()), signal == SIGTERM ? "SIGTERM" : "SIGINT");
    }
}

TEST(Interruption, EndsTheProcessAtTheSecondOneAndWhenItIsGone) {
    std::signal(SIGTERM, SIG_DFL);
    std::signal(SIGINT, SIG_DFL);
    EXPECT_EXIT(
        {
            const Interruption interruption;
            std::raise(SIGTERM);
            std::raise(SIGTERM);
        },
        ::testing::KilledBySignal(SIGTERM), "");
    EXPECT_EXIT(
        {
            { const Interruption interruption; }
            std::raise(SIGINT);
        },
        ::testing::KilledBySignal(SIGINT), "");
}

TEST(Interruption, LeavesASignalIgnoredThatWas) {
    std::signal(SIGINT, SIG_IGN);
    {
        const Interruption interruption;
        std::raise(SIGINT);
        EXPECT_EQ(Interruption::signal_name(), nullptr);
    }
    std::raise(SIGINT);
    std::signal(SIGINT, SIG_DFL);
}

TEST(Interruption, OneInsideAnotherKeepsWhatCameBetweenTwo) {
    std::signal(SIGINT, SIG_DFL);
    {
        const Interruption of_a_study;
        { const Interruption of_a_run; }
        std::raise(SIGINT); // the end of the run has not given the signal back
        const Interruption of_the_next;
        ASSERT_NE(Interruption::signal_name(), nullptr);
        EXPECT_EQ(std::string_view(Interruption::signal_name()), "SIGINT");
    }
    const Interruption of_another_study;
    EXPECT_EQ(Interruption::signal_name(), nullptr);
}

} // namespace
} // namespace slurry
