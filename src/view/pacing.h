// Internal: when pictures are drawn, and how fine.
#pragma once

namespace relief {

/// none: what is shown is up to date; coarse: fewer pixels, while something moves; full: what `relief render` draws.
enum class Quality { none, coarse, full };

/// Chooses the next picture from the times of those before it. Times are seconds on one clock.
class Pacing {
public:
    /// `budget`: seconds that a picture may take while something moves.
    explicit Pacing(double budget = 1.0 / 30) : budget_(budget) {}

    /// What is to be shown is another picture from now on.
    void change(double now);
    /// Nothing changes for a while: the next picture is a full one.
    void settle() { changedAt_ = -1e9; }
    [[nodiscard]] Quality next(double now) const;
    /// How long next() answers `none`; negative where it does so until the next change.
    [[nodiscard]] double secondsOfRest(double now) const;
    /// A picture of that quality was drawn, and took that long.
    void drew(Quality quality, double seconds);

    [[nodiscard]] bool isAtRest() const { return isFull_; }
    /// Coarse pictures have one pixel for so many each way.
    [[nodiscard]] int divisor() const { return divisor_; }

private:
    double budget_;
    double changedAt_ = 0, fullSeconds_ = -1; ///< negative: not known yet
    int divisor_ = 4;
    bool isFull_ = false, isShown_ = false; ///< the latest picture is of the latest change
};

} // namespace relief
