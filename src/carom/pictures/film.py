"""Films: pictures one after another into an MP4 or GIF file, with PyAV."""

from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import suppress
from fractions import Fraction
from pathlib import Path
from types import ModuleType, TracebackType
from typing import Any, Self

import numpy as np

from carom.errors import FileError, InputError, unwritable
from carom.pictures.caption import pillow
from carom.pictures.painter import Pixels

BLUR = {"draft": 28, "good": 18}  #: constant rate factor of H.264, by quality
RATES = {"draft": 2_000_000, "good": 12_000_000}  #: bit/s where there is no H.264
SLOWEST = 0.01  #: pictures per second; files count only so long that a picture stays
FASTEST = 240  #: pictures per second of an MP4
FASTEST_GIF = 50  #: pictures per second: browsers slow down faster ones
BT709 = 1  #: the colours of high-definition video (ITU-T H.273, table 2, 3 and 4)


def pyav() -> ModuleType:
    """PyAV.

    Raises
    ------
    InputError
        If it is not installed.
    """
    try:
        import av
    except ImportError as missing:
        msg = (
            'films need PyAV and Pillow: pip install "carom[video]"; a replay (.html) does without'
        )
        raise InputError(msg) from missing
    return av


def check(suffix: str, size: tuple[int, int], fps: float) -> None:
    """Refuse sizes and rates that a kind of film cannot have.

    Raises
    ------
    InputError
        With what to take instead, or if a library is missing.
    """
    pyav()
    if suffix == ".gif":
        pillow()
    kind, most = ("GIF", FASTEST_GIF) if suffix == ".gif" else ("film", FASTEST)
    if fps > most:
        msg = f"fps is {fps:g}; a {kind} shows {most} pictures per second at most"
        raise InputError(msg)
    if fps < SLOWEST:
        msg = f"fps is {fps:g}; a {kind} shows {SLOWEST:g} pictures per second at least"
        raise InputError(msg)
    if suffix != ".gif" and (size[0] % 2 or size[1] % 2):
        even = f"{size[0] + size[0] % 2}x{size[1] + size[1] % 2}"
        msg = f"an MP4 film cannot have the odd size {size[0]}x{size[1]}; take {even}"
        raise InputError(msg)


class Film:
    """A file that grows picture by picture, and has its name when it is whole.

    A thread encodes one picture while the next is drawn.
    Ended by an error after some pictures, it holds these: nothing that was drawn is lost.

    Parameters
    ----------
    path : Path
        Ends in ``.mp4`` or ``.gif``.
    size : (width, height)
    fps : float
    quality : {"draft", "good"}
    gamut : callable
        Gives pixels with all colours that will come, for the palette of a GIF.

    Raises
    ------
    FileError
        If the file cannot be written.
    """

    def __init__(
        self,
        path: Path,
        size: tuple[int, int],
        fps: float,
        quality: str,
        gamut: Callable[[], Pixels],
    ) -> None:
        self._path = path
        self._part = path.with_name(path.name + ".part")
        self._fps = fps
        self._gif = path.suffix.lower() == ".gif"
        if self._gif:
            self._take_palette(gamut())
        self.frames = 0
        last = str(round(100 / fps))  # hundredths of a second that the last picture stays
        options = {"final_delay": last} if self._gif else {"movflags": "+faststart"}
        kind = "gif" if self._gif else "mp4"
        try:
            self._part.touch()  # PyAV opens it with the first picture: later than one wants to know
            self._file = pyav().open(str(self._part), "w", format=kind, options=options)
        except OSError as error:
            raise self._refused(error) from error
        self._stream = self._gif_stream(size) if self._gif else self._mp4_stream(size, quality)
        self._worker = ThreadPoolExecutor(1)
        self._pending: Future[None] | None = None

    def _refused(self, error: OSError) -> FileError:
        return unwritable(self._path, error)

    def _take_palette(self, pixels: Pixels) -> None:
        self._palette = pillow()[0].fromarray(pixels).quantize(256, dither=0)
        given = np.array(self._palette.getpalette(), np.uint8).reshape(-1, 3)
        self._colors = np.zeros((256, 4), np.uint8)
        self._colors[:, 0] = 255  # opaque; then red, green, blue
        self._colors[: len(given), 1:] = given

    def _gif_stream(self, size: tuple[int, int]) -> Any:
        stream: Any = self._file.add_stream("gif", rate=100)
        stream.width, stream.height = size
        stream.pix_fmt = "pal8"
        stream.codec_context.time_base = Fraction(1, 100)
        return stream

    def _mp4_stream(self, size: tuple[int, int], quality: str) -> Any:
        rate = Fraction(self._fps).limit_denominator(1001)
        known: set[str] = pyav().codec.codecs_available
        stream: Any
        if "libx264" in known:
            stream = self._file.add_stream("libx264", rate=rate)
            stream.options = {"crf": str(BLUR[quality]), "preset": "fast"}
        else:
            name = next((n for n in ("libopenh264", "mpeg4") if n in known), "mpeg4")
            stream = self._file.add_stream(name, rate=rate)
            stream.bit_rate = RATES[quality]
        stream.width, stream.height = size
        stream.pix_fmt = "yuv420p"
        context = stream.codec_context
        context.colorspace = context.color_primaries = context.color_trc = BT709
        return stream

    def add(self, pixels: Pixels) -> None:
        """Append a picture, (height, width, 3)."""
        self._settle()
        self._pending = self._worker.submit(self._encode, pixels, self.frames)
        self.frames += 1

    def _settle(self) -> None:
        """Wait for the picture that is being encoded."""
        if self._pending is not None:
            self._pending.result()
            self._pending = None

    def _encode(self, pixels: Pixels, number: int) -> None:
        av = pyav()
        frame: Any
        if self._gif:
            image = pillow()[0].fromarray(pixels).quantize(palette=self._palette, dither=0)
            frame = av.VideoFrame.from_ndarray((np.asarray(image), self._colors), format="pal8")
            # A GIF counts in hundredths of a second; whole ones stay nearest to the truth.
            frame.pts, frame.time_base = round(100 * number / self._fps), Fraction(1, 100)
        else:
            frame = av.VideoFrame.from_ndarray(pixels, format="rgb24")
            frame = frame.reformat(format="yuv420p", dst_colorspace="ITU709")
            frame.pts = number
        self._write(self._stream.encode(frame))

    def _write(self, packets: Any) -> None:
        try:
            self._file.mux(packets)
        except OSError as error:
            raise self._refused(error) from error

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        whole = False
        try:
            self._settle()  # raises again what could not be written
            if self.frames:
                self._write(self._stream.encode(None))
                whole = True
        finally:
            self._worker.shutdown()
            self._close(whole)

    def _close(self, whole: bool) -> None:
        try:
            self._file.close()
            if whole:
                self._part.replace(self._path)
        except OSError as error:
            if whole:
                raise self._refused(error) from error
        finally:
            with suppress(OSError):
                self._part.unlink(missing_ok=True)
