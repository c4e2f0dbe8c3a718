"""One picture as PNG, HDR, PFM and OpenEXR, read by other programs: are their values ours?

  other_programs.py PROGRAM SCENE

Each program that is not installed is named; the exit status is 77 when none is.

Debian: imagemagick, openimageio-tools, netpbm, openexr, python3-pil, python3-numpy, python3-opencv.
"""
import os
import shutil
import struct
import subprocess
import sys
import tempfile

try:
    import numpy
except ImportError:
    print("SKIPPED: no numpy")
    sys.exit(77)

program, scene = sys.argv[1:3]
failures, read_by, missing = [], {}, set()


def floats(path):
    """A PFM by hand: what every other reader is held to."""
    with open(path, "rb") as file:
        kind, size, scale, data = file.read().split(b"\n", 3)
    width, height = map(int, size.split())
    channels = 3 if kind == b"PF" else 1
    order = "<f4" if float(scale) < 0 else ">f4"
    values = numpy.frombuffer(data, order, width * height * channels)
    return values.reshape(height, width, channels)[::-1]


def command(words):
    subprocess.run(words, check=True, capture_output=True)


def by_oiiotool(path):
    """As an uncompressed TIFF of floats, which is little more than the rows."""
    command([
        "oiiotool", path, "--ch", "R,G,B", "-d", "float", "--compression", "none", "-o", "out.tif"])
    with open("out.tif", "rb") as file:
        data = file.read()
    at, = struct.unpack_from("<I", data, 4)
    tags = {}
    for entry in range(struct.unpack_from("<H", data, at)[0]):
        tag, kind, count, value = struct.unpack_from("<HHII", data, at + 2 + 12 * entry)
        size, letter = {3: (2, "H"), 4: (4, "I")}.get(kind, (1, "B"))
        place = value if size * count > 4 else at + 2 + 12 * entry + 8
        tags[tag] = struct.unpack_from(f"<{count}{letter}", data, place)
    strip_offsets, strip_bytes = 273, 279
    rows = b"".join(data[o:o + n] for o, n in zip(tags[strip_offsets], tags[strip_bytes]))
    return numpy.frombuffer(rows, "<f4").reshape(picture.shape)


def by_convert(path):
    """ImageMagick 6 of Debian: 16 bits a channel, the sRGB curve left alone."""
    command(["/usr/bin/convert", path, "-set", "colorspace", "sRGB", "-depth", "16", "rgb:out.raw"])
    return numpy.fromfile("out.raw", "<u2").reshape(picture.shape) / 65535


def by_netpbm(path):
    reader = {".png": "pngtopnm", ".pfm": "pfmtopam"}[os.path.splitext(path)[1]]
    with open("out.pam", "wb") as out:
        subprocess.run([reader] + (["-maxval=65535"] if reader == "pfmtopam" else []) + [path],
                       check=True, stdout=out, stderr=subprocess.DEVNULL)
    with open("out.pam", "rb") as file:
        data = file.read()
    most = 65535 if reader == "pfmtopam" else 255
    kind = ">u2" if most > 255 else "u1"
    values = numpy.frombuffer(data[len(data) - picture.size * (2 if most > 255 else 1):], kind)
    return values.reshape(picture.shape) / most


def by_pil(path):
    from PIL import Image
    return numpy.asarray(Image.open(path).convert("RGB")) / 255


def by_opencv(path):
    os.environ["OPENCV_IO_ENABLE_OPENEXR"] = "1"
    import cv2
    values = cv2.imread(path, cv2.IMREAD_UNCHANGED)[:, :, ::-1]
    return values / 255 if values.dtype == numpy.uint8 else values


def there(name):
    if name == "PIL" or name == "OpenCV":
        try:
            __import__({"PIL": "PIL.Image", "OpenCV": "cv2"}[name])
            return True
        except ImportError:
            return False
    programs = {
        "oiiotool": "oiiotool", "ImageMagick": "/usr/bin/convert", "netpbm": "pfmtopam"}
    return shutil.which(programs[name]) is not None


def judge(name, read, ending, bound):
    """`bound`: what a value may be off, an array as the picture, or 0: every bit."""
    if not there(name):
        missing.add(name)
        return
    off = numpy.abs(read(f"picture{ending}").astype(numpy.float64) - wanted[ending])
    if (off > bound).any():
        failures.append(f"{name} reads another picture{ending}: off by {off.max():.3g}")
    else:
        read_by.setdefault(ending, []).append(f"{name} (off by {off.max():.2g})")


with tempfile.TemporaryDirectory() as folder:
    scene, program = os.path.abspath(scene), os.path.abspath(program)
    os.chdir(folder)
    for ending in (".png", ".hdr", ".pfm", ".exr"):
        command([
            program, "render", scene, "--quiet", "--size", "96x72", "--samples", "4", "-o",
            "picture" + ending])
    command([
        program, "render", scene, "--quiet", "--size", "96x72", "--layers", "depth,normal,id", "-o",
        "layers.exr"])
    picture = floats("picture.pfm").astype(numpy.float64)
    cut = numpy.clip(picture, 0, 1)
    wanted = {".png": cut, ".hdr": picture, ".pfm": picture, ".exr": picture}
    byte, word, nothing = .5 / 255 + 1e-6, 1 / 65535, 0
    # half a step, and as much where the exponent rises
    mantissa = picture.max(axis=2, keepdims=True) / 255 + 1e-7
    judge("oiiotool", by_oiiotool, ".png", byte)
    judge("oiiotool", by_oiiotool, ".hdr", mantissa)
    judge("oiiotool", by_oiiotool, ".pfm", nothing)
    judge("oiiotool", by_oiiotool, ".exr", nothing)
    judge("PIL", by_pil, ".png", byte)
    judge("OpenCV", by_opencv, ".png", byte)
    judge("OpenCV", by_opencv, ".hdr", mantissa)
    judge("OpenCV", by_opencv, ".exr", nothing)
    judge("ImageMagick", by_convert, ".png", byte + word)
    wanted.update({".hdr": cut, ".pfm": cut, ".exr": cut})  # these two cut to 0 to 1
    judge("ImageMagick", by_convert, ".hdr", mantissa + word)
    judge("ImageMagick", by_convert, ".pfm", word)
    judge("netpbm", by_netpbm, ".png", byte)
    judge("netpbm", by_netpbm, ".pfm", word)
    if shutil.which("exrheader"):
        head = subprocess.run(["exrheader", "layers.exr"], check=True, capture_output=True,
                              text=True).stdout
        for line in ("Z, 32-bit floating-point", "id, 32-bit unsigned integer", "normal.X, 32-bit",
                     'software (type string): "grelha'):
            if line not in head:
                failures.append(f"exrheader does not say {line}")
    else:
        missing.add("exrheader")

for ending, readers in read_by.items():
    print(f"{ending}: {', '.join(readers)}")
if missing:
    print("SKIPPED: not installed: " + ", ".join(sorted(missing)))
if failures:
    sys.exit("\n".join(failures))
sys.exit(0 if read_by else 77)
