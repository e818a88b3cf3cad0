"""irradia from Python, by ctypes: as much of include/irradia.h as a picture takes.

    with irradia.Context() as context, context.scene("cornell-point") as scene, context.renderer("hybrid") as renderer:
        frame = renderer.render(scene, 512, 512, slots=("image", "diffuse"))
        pixels = numpy.asarray(frame["image"])        # (512, 512, 3), float32, W/(m2 sr), linear Rec. 709

The library is found by the name in IRRADIA_LIBRARY, or where the system looks for libirradia.
"""

import ctypes
import ctypes.util
import os

SLOTS = {"emission": 1, "direct": 2, "diffuse": 4, "caustics": 8, "specular": 16, "image": 32}


class Error(Exception):
    """A call did not do what it was asked to; the message is irradia's sentence."""

    def __init__(self, status, sentence):
        super().__init__(sentence)
        self.status = status


class _Descriptor(ctypes.Structure):
    """Begins with its size; what is not given is zero."""

    def __init__(self, **fields):
        super().__init__(size=ctypes.sizeof(self), **fields)


class _RendererDescriptor(_Descriptor):
    _fields_ = [("size", ctypes.c_size_t), ("technique", ctypes.c_char_p), ("preset", ctypes.c_char_p)]


class _ContextDescriptor(_Descriptor):
    _fields_ = [
        ("size", ctypes.c_size_t),
        ("device", ctypes.c_char_p),
        ("validation", ctypes.c_uint32),
        ("log_level", ctypes.c_uint32),
        ("log", ctypes.c_void_p),
        ("log_user", ctypes.c_void_p),
        ("host_device", ctypes.c_void_p),
    ]


class _FrameDescriptor(_Descriptor):
    _fields_ = [
        ("size", ctypes.c_size_t),
        ("width", ctypes.c_uint32),
        ("height", ctypes.c_uint32),
        ("camera", ctypes.c_void_p),
        ("camera_name", ctypes.c_char_p),
        ("slots", ctypes.c_uint32),
        ("tone_map", ctypes.c_uint32),
        ("index", ctypes.c_uint32),
        ("time_step", ctypes.c_float),
        ("timing", ctypes.c_uint32),
        ("reserved", ctypes.c_uint32),
        ("progress", ctypes.c_void_p),
        ("progress_user", ctypes.c_void_p),
        ("targets", ctypes.c_void_p),
        ("target_count", ctypes.c_size_t),
        ("stay_on_device", ctypes.c_uint32),
        ("patience", ctypes.c_float),
        ("waits", ctypes.c_void_p),
        ("wait_count", ctypes.c_size_t),
        ("signals", ctypes.c_void_p),
        ("signal_count", ctypes.c_size_t),
    ]


class _PixelsDescriptor(_Descriptor):
    _fields_ = [
        ("size", ctypes.c_size_t),
        ("slot", ctypes.c_uint32),
        ("format", ctypes.c_uint32),
        ("pixels", ctypes.c_void_p),
        ("byte_count", ctypes.c_size_t),
        ("row_stride", ctypes.c_size_t),
    ]


class _TimingsDescriptor(_Descriptor):
    _fields_ = [
        ("size", ctypes.c_size_t),
        ("gpu_ms", ctypes.c_double),
        ("host_ms", ctypes.c_double),
        ("upload_ms", ctypes.c_double),
        ("pipeline_ms", ctypes.c_double),
        ("pass_count", ctypes.c_size_t),
        ("memory_count", ctypes.c_size_t),
        ("samples", ctypes.c_uint32),
        ("reserved", ctypes.c_uint32),
        ("rays", ctypes.c_uint64),
        ("upload_bytes", ctypes.c_uint64),
    ]


class _PassDescriptor(_Descriptor):
    _fields_ = [
        ("size", ctypes.c_size_t),
        ("name", ctypes.c_char_p),
        ("ms", ctypes.c_double),
        ("skipped", ctypes.c_char_p),
    ]


def _load():
    name = os.environ.get("IRRADIA_LIBRARY") or ctypes.util.find_library("irradia") or "libirradia.so"
    library = ctypes.CDLL(name)
    library.irradia_last_error.restype = ctypes.c_char_p
    library.irradia_version.restype = ctypes.c_uint32
    return library


_library = _load()


def _call(name, *arguments):
    function = getattr(_library, name)
    function.restype = ctypes.c_uint32
    status = function(*arguments)
    if status != 0:
        raise Error(status, _library.irradia_last_error().decode())


class _Handle:
    _destroy = ""

    def __init__(self):
        self._pointer = ctypes.c_void_p()

    def close(self):
        """Ends it; more than once is allowed."""
        pointer, self._pointer = self._pointer, ctypes.c_void_p()
        destroy = getattr(_library, self._destroy)
        destroy.restype = None
        destroy(pointer)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()


class Context(_Handle):
    """A Vulkan device."""

    _destroy = "irradia_context_destroy"

    def __init__(self, device=None):
        super().__init__()
        descriptor = _ContextDescriptor(device=device and device.encode())
        _call("irradia_context_create", ctypes.byref(descriptor), ctypes.byref(self._pointer))

    def scene(self, name_or_path):
        """A glTF file, or a scene that comes with irradia."""
        return Scene(self, name_or_path)

    def renderer(self, technique="hybrid", preset="default", settings=None):
        """A renderer; settings as {"vpl.count": 2000}."""
        return Renderer(self, technique, preset, settings or {})


class Scene(_Handle):
    """What there is to light."""

    _destroy = "irradia_scene_destroy"

    def __init__(self, context, name_or_path):
        super().__init__()
        _call("irradia_scene_open", context._pointer, os.fsencode(name_or_path), None, ctypes.byref(self._pointer))

    def set_time(self, seconds):
        """Puts all that is animated where it is at a time."""
        _call("irradia_scene_set_time", self._pointer, ctypes.c_double(seconds))


class Renderer(_Handle):
    """Settings, and what frames leave on the device for the next one."""

    _destroy = "irradia_renderer_destroy"

    def __init__(self, context, technique, preset, settings):
        super().__init__()
        descriptor = _RendererDescriptor(technique=technique.encode(), preset=preset.encode())
        _call("irradia_renderer_create", context._pointer, ctypes.byref(descriptor), ctypes.byref(self._pointer))
        for key, value in settings.items():
            self.set(key, value)

    def set(self, key, value):
        """As --set key=value on the command line."""
        _call("irradia_renderer_set", self._pointer, key.encode(), str(value).encode())

    def render(self, scene, width, height, slots=("image",), index=0, passes=False):
        """A frame: each slot by name as rows of pixels, and `timings`."""
        descriptor = _FrameDescriptor(
            width=width, height=height, slots=sum(SLOTS[slot] for slot in slots), index=index, timing=int(passes)
        )
        pointer = ctypes.c_void_p()
        _call("irradia_render", self._pointer, scene._pointer, ctypes.byref(descriptor), ctypes.byref(pointer))
        try:
            return Frame(pointer, width, height, slots)
        finally:
            _library.irradia_frame_destroy(pointer)


class Frame(dict):
    """Pixels by slot: memory views of shape (height, width, 3), which numpy.asarray takes as they are."""

    def __init__(self, pointer, width, height, slots):
        super().__init__()
        for slot in slots:
            pixels = (ctypes.c_float * (width * height * 3))()
            target = _PixelsDescriptor(
                slot=SLOTS[slot], pixels=ctypes.addressof(pixels), byte_count=ctypes.sizeof(pixels)
            )
            _call("irradia_frame_copy", pointer, ctypes.byref(target))
            self[slot] = memoryview(pixels).cast("B").cast("f", (height, width, 3))
        timings = _TimingsDescriptor()
        _call("irradia_frame_timings", pointer, ctypes.byref(timings))
        self.gpu_ms, self.host_ms = timings.gpu_ms, timings.host_ms
        self.passes = []
        for index in range(timings.pass_count):
            one = _PassDescriptor()
            _call("irradia_frame_pass", pointer, ctypes.c_size_t(index), ctypes.byref(one))
            self.passes.append((one.name.decode(), one.ms, one.skipped and one.skipped.decode()))
