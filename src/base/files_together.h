// For other modules: several output files that appear together or not at all.
#pragma once

namespace relief {

/// While it lives, files that writeWhole() writes on this thread wait: all paths are as they were until takePlaces(). A
/// disk that is full at the last file loses nothing of what was there under the names of the first. Files that wait
/// cannot be read by their names. Only one may live on a thread.
class FilesTogether {
public:
    FilesTogether();
    FilesTogether(const FilesTogether&) = delete;
    FilesTogether& operator=(const FilesTogether&) = delete;
    ~FilesTogether(); ///< drops files that have not taken their places

    /// Puts all files in their places. Throws Failure::file where a folder takes no more names, which is all that a
    /// full disk can still refuse; no file has taken its place then. Where a later rename fails, as of a folder that
    /// was removed meanwhile, the files before it keep their places.
    void takePlaces();
};

} // namespace relief
