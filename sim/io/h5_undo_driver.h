#pragma once
// An HDF5 file driver over UndoFile: HDF5 files that can be taken back to a mark.
#include "sim/io/h5_file.h"
#include "sim/io/undo_file.h"

namespace scree {

/// Properties for H5Fcreate and H5Fopen that choose the driver. One negative when HDF5 refuses it.
H5Handle undo_access();

/// The file below an HDF5 file that was opened with undo_access(); null if it was not.
UndoFile* undo_file_of(hid_t file);

}  // namespace scree
