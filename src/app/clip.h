// Moving pictures through ffmpeg, which is found when it is needed.
#pragma once

#include <cstdio>
#include <string>

#include <sys/types.h>

#include "frame/frame.h"

namespace relief::app {

/// .mp4, .webm, .gif or .webp.
bool isClipPath(const std::string& path);

/// Throws Failure::file unless ffmpeg can be started.
void checkClipWriter();

struct ClipDesc {
    std::string path;      ///< what it will be called: its extension names the format
    std::string temporary; ///< where it is written
    int width = 0, height = 0;
    double fps = 24;
};

/// Frames of one size, handed to an ffmpeg that runs beside. Throws Failure::file when it ends before its time.
class ClipWriter {
public:
    explicit ClipWriter(const ClipDesc& desc);
    ~ClipWriter(); ///< ends ffmpeg when finish() was not reached
    ClipWriter(const ClipWriter&) = delete;
    ClipWriter& operator=(const ClipWriter&) = delete;

    /// 3 channels of 0..1, sRGB-encoded.
    void write(const Image& frame);
    /// Waits for the file to be whole.
    void finish();

private:
    ClipDesc desc_;
    pid_t process_ = -1;
    int pipe_ = -1;
};

} // namespace relief::app
