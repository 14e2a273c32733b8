// Internal: pictures as the codes that a screen shows.
#pragma once

#include <array>

#include "frame/frame.h"

namespace relief {

/// Red, green, blue and 255 per pixel, from the top row.
struct Codes {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgba;
};

/// The codes that writePicture() writes to a .png; a transparent background is shown as a checkerboard.
Codes developExactly(const Picture& picture, const Finish& finish);

/// Makes the same codes by a table, quickly; at the object's outline they may differ a little.
class Developer {
public:
    Codes develop(const Picture& picture, const Finish& finish);

private:
    void makeTable(const Finish& finish, bool isDisplayReferred);
    void makeBackground(int width, int height, const Finish& finish);

    std::optional<std::pair<double, bool>> tableOf_; ///< exposure, whether display referred
    std::array<std::uint8_t, 65536> table_{};        ///< code of each half
    std::optional<Finish> finish_;                   ///< of the background
    Codes background_;
};

/// Joins two pictures of one size: the columns from `divider` on are those of `right`.
void joinColumns(Codes& left, const Codes& right, int divider);
/// Shows how far each channel of `right` is from that of `left`, `gain` times as large, from `divider` on.
void joinDifference(Codes& left, const Codes& right, int divider, int gain);

} // namespace relief
