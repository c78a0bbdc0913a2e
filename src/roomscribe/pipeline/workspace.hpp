// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "roomscribe/core/context.hpp"
#include "roomscribe/core/settings.hpp"
#include "roomscribe/model/scan.hpp"
#include "roomscribe/pipeline/reconstruct.hpp"

namespace roomscribe {

enum class FileRole : std::uint8_t { scan, poses, corrections, result };

/// A file that went into a run or came out of it.
struct FileRecord {
    std::string path;         ///< of a result its name in the output folder
    std::uint64_t size = 0;   ///< bytes
    std::uint64_t xxh64 = 0;  ///< hash_file
    FileRole role = FileRole::scan;
};

/// What is to be known of a run beside its results.
struct RunRecord {
    std::string version;                 ///< of the program
    std::string command;                 ///< "run", "register", "interpret"
    std::vector<SettingEntry> settings;  ///< list_settings(PipelineSettings)
    std::vector<FileRecord> inputs;      ///< in input order
    std::vector<FileRecord> results;     ///< describe_results
    int num_threads = 0;                 ///< that the run used
};

/// "scan", "poses", "corrections", "result".
std::string_view file_role_name(FileRole role);

/// Size and hash of a file. Throws IoError if it cannot be read.
FileRecord describe_input(const std::filesystem::path& path, FileRole role = FileRole::scan);

/// The files that write_registration and write_interpretation have left in the folder.
std::vector<FileRecord> describe_results(const std::filesystem::path& folder);

/// Makes the folder, with its parents, and tries whether a file can be written in it: called before
/// the work starts, so that a long run does not end without a place for its result. Half-written
/// files of killed runs are removed. Throws IoError.
void prepare_output_folder(const std::filesystem::path& folder);

/// Where in a result's folder the i-th map of `Reconstruction::apart` has its own: "set-2" is the
/// first, for the map itself is set 1.
std::string folder_of_apart(std::size_t i);

/// Removes the folders of maps apart that an earlier run left in `folder`, from the `count`-th on;
/// of one with a corrections.json that file stays, for it is the user's.
void remove_apart_from(const std::filesystem::path& folder, std::size_t count);

// Each of the following writes into an existing folder the files of docs/formats.md, every one
// under a temporary name that is then renamed: a killed run leaves whole files or none. All
// coordinates in files are file coordinates, global shifts included. They throw IoError if a file
// cannot be written.

/// poses.txt, registration.json and map.ply. Precondition: reconstruction.registration holds, with
/// one pose slot per section of the map.
void write_registration(const std::filesystem::path& folder, const Reconstruction& reconstruction,
                        const Context& context = {});

/// labels.ply and scene.json. Precondition: labels are given for every point of the map.
void write_interpretation(const std::filesystem::path& folder, const Reconstruction& reconstruction,
                          const Context& context = {});

/// run.json: the record, with the stage costs and derived values of the reconstruction.
void write_run_record(const std::filesystem::path& folder, const RunRecord& record,
                      const Reconstruction& reconstruction);

/// The text of run.json.
std::string run_to_json(const RunRecord& record, const Reconstruction& reconstruction);

}  // namespace roomscribe
