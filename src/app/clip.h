// Clips, encoded by ffmpeg, which is looked for when it is needed.
#pragma once

#include <cstdio>
#include <string>

#include <sys/types.h>

#include "frame/frame.h"

namespace relief::app {

/// Whether `path` names a clip: .mp4, .webm, .gif or .webp.
bool isClipPath(const std::string& path);

/// Throws Failure::file unless ffmpeg is installed and runs.
void checkClipWriter();

struct ClipDesc {
    std::string path;      ///< of the finished clip: its extension names the format
    std::string temporary; ///< the file that is written
    int width = 0, height = 0;
    double fps = 0; ///< frames per second
};

/// Passes frames of one size to an ffmpeg process. Throws Failure::file when that ends before finish().
class ClipWriter {
public:
    explicit ClipWriter(const ClipDesc& desc);
    ~ClipWriter(); ///< ends ffmpeg unless finish() was called
    ClipWriter(const ClipWriter&) = delete;
    ClipWriter& operator=(const ClipWriter&) = delete;

    /// Adds a frame of 3 channels 0..1, sRGB-encoded.
    void write(const Image& frame);
    /// Waits until ffmpeg has written the file.
    void finish();

private:
    ClipDesc desc_;
    pid_t process_ = -1;
    int pipe_ = -1;
};

} // namespace relief::app
