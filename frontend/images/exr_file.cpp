#include "frontend/images/exr_file.hpp"

#include <OpenEXR/openexr.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <new>

#include "frontend/files/parse_error.hpp"

namespace grelha {
namespace {

constexpr int kMostExrSide = 65536;
constexpr std::uint64_t kMostPixelsAByte =
    1024;  ///< deflate packs a thousandfold at most, so a file may claim no more
constexpr int kExrZipLevel = 4;  ///< as for PNG

/// A file in memory, and the first error of the library.
struct ExrMemory {
  std::string bytes;
  std::string error;
};

ExrMemory& memory_of(exr_const_context_t context) {
  void* memory = nullptr;
  exr_get_user_data(context, &memory);
  return *static_cast<ExrMemory*>(memory);
}

std::int64_t read_from(exr_const_context_t,
                       void* user,
                       void* to,
                       std::uint64_t size,
                       std::uint64_t offset,
                       exr_stream_error_func_ptr_t) {
  const std::string& bytes = static_cast<ExrMemory*>(user)->bytes;
  if (offset >= bytes.size())
    return 0;
  const std::size_t n = std::min<std::size_t>(size, bytes.size() - offset);
  std::memcpy(to, bytes.data() + offset, n);
  return std::int64_t(n);
}

std::int64_t write_to(exr_const_context_t,
                      void* user,
                      const void* from,
                      std::uint64_t size,
                      std::uint64_t offset,
                      exr_stream_error_func_ptr_t) {
  std::string& bytes = static_cast<ExrMemory*>(user)->bytes;
  if (offset + size > bytes.size())
    bytes.resize(offset + size);
  std::memcpy(bytes.data() + offset, from, size);
  return std::int64_t(size);
}

/// Stores a message of the library. It may quote names from the file, with any bytes.
void complain(exr_const_context_t context, exr_result_t, const char* message) {
  if (!context)
    return;
  std::string& error = memory_of(context).error;
  if (!error.empty())
    return;
  error = message;
  std::replace_if(
      error.begin(), error.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
}

/// True if an allocation failed: the library reports lack of memory for damaged blocks as well
/// (OpenEXR 3.1, B44), and gives take_memory() no context.
thread_local bool allocation_failed = false;

void* take_memory(std::size_t size) {
  void* const memory = std::malloc(size);
  allocation_failed = allocation_failed || !memory;
  return memory;
}

exr_context_initializer_t initializer(ExrMemory& memory) {
  allocation_failed = false;
  exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
  init.alloc_fn = take_memory;
  init.free_fn = std::free;
  init.error_handler_fn = complain;
  init.user_data = &memory;
  init.read_fn = read_from;
  init.size_fn = [](exr_const_context_t, void* user) {
    return std::int64_t(static_cast<ExrMemory*>(user)->bytes.size());
  };
  init.write_fn = write_to;
  init.max_image_width = init.max_image_height = kMostExrSide;
  init.max_tile_width = init.max_tile_height = kMostExrSide;
  init.zip_level = kExrZipLevel;
  init.flags = EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION;
  return init;
}

class ExrContext {
 public:
  ExrContext() = default;
  ~ExrContext() {
    if (context)
      exr_finish(&context);
  }
  ExrContext(const ExrContext&) = delete;
  ExrContext& operator=(const ExrContext&) = delete;
  exr_context_t context = nullptr;
};

/// One channel to write: where its first value lies, and how far apart values are.
struct ExrChannel {
  const char* name;
  const void* values;
  int stride;  ///< bytes from a pixel to the next
  bool whole;  ///< 32-bit whole numbers, else floats
};

/// The channels by name, in the order of the file.
std::vector<ExrChannel> channels_of(const Image& image, const Layers& layers) {
  constexpr int kThree = 3 * sizeof(float), kOne = sizeof(float);
  const float* const rgb = image.rgb.data();
  std::vector<ExrChannel> all{
      {"B", rgb + 2, kThree, false}, {"G", rgb + 1, kThree, false}, {"R", rgb, kThree, false}};
  if (!layers.depth.empty())
    all.push_back({"Z", layers.depth.data(), kOne, false});
  if (!layers.id.empty())
    all.push_back({"id", layers.id.data(), kOne, true});
  const float* const normal = layers.normal.data();
  if (normal) {
    all.push_back({"normal.X", normal, kThree, false});
    all.push_back({"normal.Y", normal + 1, kThree, false});
    all.push_back({"normal.Z", normal + 2, kThree, false});
  }
  return all;
}

/// Throws where a step failed: here only memory can be lacking.
void check_result(exr_result_t result) {
  if (result != EXR_ERR_SUCCESS)
    throw std::bad_alloc();
}

std::string attribute_name(std::string key) {
  for (char& c : key)
    c = c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
  return key;
}

void write_head(exr_context_t file,
                const Image& image,
                const std::vector<ExrChannel>& channels,
                const Notes& notes) {
  int part = 0;
  check_result(exr_add_part(file, "", EXR_STORAGE_SCANLINE, &part));
  check_result(exr_initialize_required_attr_simple(
      file, part, image.width, image.height, EXR_COMPRESSION_ZIP));
  for (const ExrChannel& c : channels)
    check_result(exr_add_channel(file,
                                 part,
                                 c.name,
                                 c.whole ? EXR_PIXEL_UINT : EXR_PIXEL_FLOAT,
                                 EXR_PERCEPTUALLY_LOGARITHMIC,
                                 1,
                                 1));
  for (const auto& [key, text] : notes)
    check_result(exr_attr_set_string(file, part, attribute_name(key).c_str(), text.c_str()));
  check_result(exr_write_header(file));
}

/// Readers take a block of its full size for one that is not packed; OpenEXR 3.1 writes packed
/// bytes too when they are just as many. Its own routine stands in encoding_user_data.
exr_result_t compress(exr_encode_pipeline_t* pipeline) {
  using Routine = decltype(pipeline->compress_fn);
  const auto own = *static_cast<const Routine*>(pipeline->encoding_user_data);
  const exr_result_t result = own(pipeline);
  if (result == EXR_ERR_SUCCESS && pipeline->compressed_bytes == pipeline->packed_bytes)
    std::memcpy(pipeline->compressed_buffer, pipeline->packed_buffer, pipeline->packed_bytes);
  return result;
}

void write_blocks(exr_context_t file, const Image& image, const std::vector<ExrChannel>& channels) {
  int rows = 0;
  check_result(exr_get_scanlines_per_chunk(file, 0, &rows));
  exr_encode_pipeline_t pipeline = EXR_ENCODE_PIPELINE_INITIALIZER;
  auto own = pipeline.compress_fn;
  for (int y = 0; y < image.height; y += rows) {
    exr_chunk_info_t block;
    check_result(exr_write_scanline_chunk_info(file, 0, y, &block));
    check_result(y == 0 ? exr_encoding_initialize(file, 0, &block, &pipeline)
                        : exr_encoding_update(file, 0, &block, &pipeline));
    for (std::size_t i = 0; i < channels.size(); ++i) {
      const ExrChannel& c = channels[i];
      const std::size_t line = std::size_t(c.stride) * std::size_t(image.width);
      exr_coding_channel_info_t& to = pipeline.channels[i];
      to.user_pixel_stride = c.stride;
      to.user_line_stride = int(line);
      to.user_bytes_per_element = sizeof(float);
      to.user_data_type = c.whole ? EXR_PIXEL_UINT : EXR_PIXEL_FLOAT;
      to.encode_from_ptr = static_cast<const std::uint8_t*>(c.values) + line * std::size_t(y);
    }
    if (y == 0) {
      check_result(exr_encoding_choose_default_routines(file, 0, &pipeline));
      own = pipeline.compress_fn;
      pipeline.encoding_user_data = &own;
      pipeline.compress_fn = compress;
    }
    check_result(exr_encoding_run(file, 0, &pipeline));
  }
  exr_encoding_destroy(file, &pipeline);
}

/// Reads one part of a file into an image.
class ExrReader {
 public:
  ExrReader(const std::string& path, const std::string& bytes) : path_(path), memory_{bytes, ""} {
    const exr_context_initializer_t init = initializer(memory_);
    expect_that(exr_start_read(&file_.context, path.c_str(), &init));
  }

  Image run() {
    find_part();
    exr_attr_box2i_t window;
    expect_that(exr_get_data_window(file_.context, part_, &window));
    expect_that(exr_get_display_window(file_.context, part_, &display_));
    const std::int64_t width = side(display_.min.x, display_.max.x),
                       height = side(display_.min.y, display_.max.y);
    const auto data = std::uint64_t(side(window.min.x, window.max.x)) *
                      std::uint64_t(side(window.min.y, window.max.y));
    if (std::max(data, std::uint64_t(width * height)) > memory_.bytes.size() * kMostPixelsAByte)
      reject("it claims more pixels than its bytes can hold");
    image_ = Image(int(width), int(height));
    exr_storage_t storage;
    expect_that(exr_get_storage(file_.context, part_, &storage));
    if (storage == EXR_STORAGE_SCANLINE)
      read_rows(window);
    else if (storage == EXR_STORAGE_TILED)
      read_tiles();
    else
      reject("its pixels are deep");
    return std::move(image_);
  }

 private:
  [[noreturn]] void reject(const std::string& why) const {
    throw FileError(path_, "cannot read the picture: " + why);
  }
  void expect_that(exr_result_t result) const {
    if (result == EXR_ERR_OUT_OF_MEMORY && allocation_failed)
      throw std::bad_alloc();
    if (result == EXR_ERR_OUT_OF_MEMORY)
      reject("a block of its pixels is damaged");
    if (result != EXR_ERR_SUCCESS)
      reject(memory_.error.empty() ? exr_get_default_error_message(result) : memory_.error);
  }
  std::int64_t side(int from, int to) const {
    const std::int64_t size = std::int64_t(to) - from + 1;
    if (size < 1 || size > kMostExrSide)
      reject("width and height must be 1 to 65536");
    return size;
  }

  bool has(const exr_attr_chlist_t& list, const char* name) const {
    for (int i = 0; i < list.num_channels; ++i) {
      const exr_attr_chlist_entry_t& c = list.entries[i];
      if (std::strcmp(c.name.str, name) == 0)
        return c.x_sampling == 1 && c.y_sampling == 1;
    }
    return false;
  }

  void find_part() {
    int parts = 0;
    expect_that(exr_get_count(file_.context, &parts));
    for (part_ = 0; part_ < parts; ++part_) {
      const exr_attr_chlist_t* list = nullptr;
      expect_that(exr_get_channels(file_.context, part_, &list));
      grey_ = has(*list, "Y");
      if (grey_ || (has(*list, "R") && has(*list, "G") && has(*list, "B")))
        return;
    }
    reject("no part of it has the channels R, G and B");
  }

  /// Which of the three colours a channel is, or -1.
  int color_of(const char* name) const {
    const std::string_view word(name), known(grey_ ? "Y" : "RGB");
    const std::size_t at = word.size() == 1 ? known.find(word) : known.npos;
    return at == known.npos ? -1 : int(at);
  }

  /// Unpacks a block apart from the image, because it may reach beyond the display window.
  void read_block(const exr_chunk_info_t& block, int x, int y) {
    const std::size_t pixels = std::size_t(block.width) * std::size_t(block.height);
    std::array<std::vector<float>, 3> planes;
    exr_decode_pipeline_t pipeline = EXR_DECODE_PIPELINE_INITIALIZER;
    exr_result_t result = exr_decoding_initialize(file_.context, part_, &block, &pipeline);
    for (int i = 0; result == EXR_ERR_SUCCESS && i < pipeline.channel_count; ++i) {
      exr_coding_channel_info_t& c = pipeline.channels[i];
      const int colour = color_of(c.channel_name);
      if (colour < 0)
        continue;
      planes[std::size_t(colour)].resize(pixels);
      c.decode_to_ptr = reinterpret_cast<std::uint8_t*>(planes[std::size_t(colour)].data());
      c.user_data_type = EXR_PIXEL_FLOAT;
      c.user_bytes_per_element = c.user_pixel_stride = sizeof(float);
      c.user_line_stride = int(sizeof(float)) * block.width;
    }
    if (result == EXR_ERR_SUCCESS)
      result = exr_decoding_choose_default_routines(file_.context, part_, &pipeline);
    if (result == EXR_ERR_SUCCESS)
      result = exr_decoding_run(file_.context, part_, &pipeline);
    exr_decoding_destroy(file_.context, &pipeline);
    expect_that(result);
    copy_block(planes, block.width, block.height, x - display_.min.x, y - display_.min.y);
  }

  void copy_block(
      const std::array<std::vector<float>, 3>& planes, int width, int height, int left, int top) {
    for (int y = std::max(0, -top); y < height && top + y < image_.height; ++y)
      for (int x = std::max(0, -left); x < width && left + x < image_.width; ++x)
        for (std::size_t c = 0; c < 3; ++c)
          image_.row(top + y)[std::size_t(left + x) * 3 + c] =
              planes[grey_ ? 0 : c][std::size_t(y) * std::size_t(width) + std::size_t(x)];
  }

  void read_rows(const exr_attr_box2i_t& window) {
    int rows = 0;
    expect_that(exr_get_scanlines_per_chunk(file_.context, part_, &rows));
    for (std::int64_t y = window.min.y; y <= window.max.y; y += rows) {
      exr_chunk_info_t block;
      expect_that(exr_read_scanline_chunk_info(file_.context, part_, int(y), &block));
      read_block(block, window.min.x, int(y));
    }
  }

  void read_tiles() {
    exr_attr_box2i_t window;
    expect_that(exr_get_data_window(file_.context, part_, &window));
    int tile_width = 0, tile_height = 0, width = 0, height = 0;
    expect_that(exr_get_tile_sizes(file_.context, part_, 0, 0, &tile_width, &tile_height));
    expect_that(exr_get_level_sizes(file_.context, part_, 0, 0, &width, &height));
    for (int y = 0; y * tile_height < height; ++y)
      for (int x = 0; x * tile_width < width; ++x) {
        exr_chunk_info_t block;
        expect_that(exr_read_tile_chunk_info(file_.context, part_, x, y, 0, 0, &block));
        read_block(block, window.min.x + x * tile_width, window.min.y + y * tile_height);
      }
  }

  const std::string& path_;
  ExrMemory memory_;
  ExrContext file_;
  int part_ = 0;
  bool grey_ = false;
  exr_attr_box2i_t display_{};
  Image image_;
};

}  // namespace

std::string encode_exr(const Image& image, const Layers& layers, const Notes& notes) {
  ExrMemory memory;
  const exr_context_initializer_t init = initializer(memory);
  {
    ExrContext file;
    check_result(exr_start_write(&file.context, "picture.exr", EXR_WRITE_FILE_DIRECTLY, &init));
    const std::vector<ExrChannel> channels = channels_of(image, layers);
    write_head(file.context, image, channels, notes);
    write_blocks(file.context, image, channels);
  }  // the table of blocks is written last
  return std::move(memory.bytes);
}

Image read_exr(const std::string& path, const std::string& bytes) {
  if (!bytes.starts_with("\x76\x2f\x31\x01"))
    throw FileError(path, "not a picture in the OpenEXR format");
  return ExrReader(path, bytes).run();
}

}  // namespace grelha
