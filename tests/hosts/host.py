"""A Python program that uses the library through examples/python/irradia.py: host.py OUTPUT."""

import sys

import irradia

with irradia.Context() as context, context.scene("cornell-point") as scene, context.renderer("hybrid") as renderer:
    for wrong in (lambda: context.scene("no such scene"), lambda: renderer.set("vpl.cuont", 3), lambda: irradia.Context("nobody's")):
        try:
            wrong()
            sys.exit("wrong use was no error")
        except irradia.Error as error:
            assert error.status != 0 and len(str(error)) > 20, error
    frame = renderer.render(scene, 64, 48, slots=("image", "diffuse"), passes=True)

image = frame["image"]
assert image.shape == (48, 64, 3) and frame.gpu_ms > 0 and len(frame.passes) > 5
try:
    import numpy
except ImportError:
    pass
else:
    pixels = numpy.asarray(image)
    assert pixels.dtype == numpy.float32 and numpy.isfinite(pixels).all() and pixels.mean() > 0
with open(sys.argv[1], "wb") as file:
    file.write(image)
