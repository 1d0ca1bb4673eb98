// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/output/snapshot_files.h>
#include <crawler/output/vtu_files.h>
#include <crawler/output/xdmf_files.h>

namespace crawler
{
  std::unique_ptr<SnapshotFiles>
  snapshot_files(const SnapshotFormat format,
                 const std::filesystem::path &folder,
                 const double length,
                 const std::size_t n_frames)
  {
    if (format == SnapshotFormat::xdmf)
      return std::make_unique<XdmfFiles>(folder, length, n_frames);
    return std::make_unique<VtuFiles>(folder, length);
  }

  std::string
  animation_file(const SnapshotFormat format)
  {
    return format == SnapshotFormat::xdmf ? "solution.xdmf" : "solution.pvd";
  }
} // namespace crawler
