#include "app/frames.h"

#include <charconv>

#include "base/base.h"

namespace relief::app {
namespace {

constexpr std::int64_t kMostFrames = 1'000'000;

/// Walks a frame list from left to right.
class Reader {
public:
    explicit Reader(const std::string& text) : text_(text) {}

    std::vector<int> read() {
        do readRange();
        while (take(','));
        if (at_ != text_.size()) refuse("a comma or the end");
        return std::move(frames_);
    }

private:
    void readRange() {
        const std::int64_t first = number();
        const std::int64_t last = take(':') ? number() : first;
        const std::int64_t step = first != last && take('x') ? number() : 1;
        if (step < 1) fail(Failure::usage, "--frames {}: a step of {} is not 1 or more", text_, step);
        const std::int64_t count = std::abs(last - first) / step + 1;
        if (count + std::int64_t(frames_.size()) > kMostFrames)
            fail(Failure::usage, "--frames {}: these are more than {} frames", text_, kMostFrames);
        for (std::int64_t k = 0; k < count; ++k)
            frames_.push_back(int(last < first ? first - k * step : first + k * step));
    }

    std::int64_t number() {
        int value = 0;
        const char* begin = text_.data() + at_;
        const auto [end, error] = std::from_chars(begin, text_.data() + text_.size(), value);
        if (error != std::errc()) refuse("a frame number");
        at_ += std::size_t(end - begin);
        return value;
    }

    bool take(char letter) {
        if (at_ == text_.size() || text_[at_] != letter) return false;
        ++at_;
        return true;
    }

    [[noreturn]] void refuse(const char* expected) const {
        fail(Failure::usage, "--frames {}: {} expected at character {}; write 24, 1:24 or 101:109x2", text_, expected,
             at_ + 1);
    }

    const std::string& text_;
    std::size_t at_ = 0;
    std::vector<int> frames_;
};

} // namespace

std::vector<int> parseFrames(const std::string& text) { return Reader(text).read(); }

} // namespace relief::app
