// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <hdf5.h>

namespace crawler
{
  /// An object of HDF5, closed at the end of its life; nothing is closed if the identifier is negative, HDF5's sign of
  /// a failed call.
  class Hdf5Handle
  {
  public:
    Hdf5Handle(const hid_t id, herr_t (*close)(hid_t))
      : id_(id)
      , close_(close)
    {
    }
    Hdf5Handle(const Hdf5Handle &) = delete;
    ~Hdf5Handle()
    {
      if (id_ >= 0)
        close_(id_);
    }
    operator hid_t() const
    {
      return id_;
    }

  private:
    const hid_t id_;
    herr_t (*const close_)(hid_t);
  };
} // namespace crawler
