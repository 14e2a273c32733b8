// Internal: what a TIFF's directories say that its reader ignores.
#pragma once

#include <optional>
#include <string>

namespace relief {

struct TiffFacts {
    bool isWhole = true;          ///< all directories, their values, strips and tiles end inside the file
    std::optional<double> noData; ///< the first page's GDAL_NODATA (tag 42113), as stored; may be NaN
    std::optional<double> first;  ///< the first page's first sample, where it is 64 bits long and not compressed
};

/// Reads the directories of a TIFF or BigTIFF of either byte order (TIFF revision 6.0, section 2), no picture data.
TiffFacts readTiffFacts(const std::string& path);

} // namespace relief
