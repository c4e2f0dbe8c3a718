#pragma once

#include "frontend/commands/commands.hpp"
#include "frontend/images/image_style.hpp"
#include "grelha/image.hpp"

namespace grelha {

/// Throws UsageError for a sheet of a command's views that is too large for its format, and
/// FileError for one that does not fit into memory.
void check_sheet(const RenderCommand& command, const Camera& camera);

/// The pictures of a turntable: a file each, where {} in the name is their number, from 0 and with
/// as many digits as the last; or one sheet of all, row by row, nearly square. Without a turntable
/// it is one view.
class ViewFiles {
 public:
  /// `background`: colour of the rest of the sheet.
  ViewFiles(const RenderCommand& command, const Float3& background)
      : command_(command), background_(background) {}
  void add(int number, const Image& view, const ImageStyle& style);
  void finish() const;  ///< writes the sheet

 private:
  const RenderCommand& command_;
  Float3 background_;
  Image sheet_;
  ImageStyle style_;  ///< of the sheet
};

}  // namespace grelha
