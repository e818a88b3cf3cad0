"""Draws a frame, and what its passes cost: draw.py [SCENE] [TECHNIQUE]. Takes NumPy and Matplotlib."""

import sys

import matplotlib.pyplot as plot
import numpy

import irradia

scene_name = sys.argv[1] if len(sys.argv) > 1 else "cornell-point"
technique = sys.argv[2] if len(sys.argv) > 2 else "hybrid"
with irradia.Context() as context, context.scene(scene_name) as scene, context.renderer(technique) as renderer:
    frame = renderer.render(scene, 512, 512, passes=True)

radiance = numpy.asarray(frame["image"])
shown = numpy.clip(radiance / numpy.quantile(radiance, 0.98), 0, 1) ** (1 / 2.2)
ran = sorted((pair for pair in ((name, ms) for name, ms, _ in frame.passes) if pair[1] > 0), key=lambda pair: pair[1])
figure, (picture, bars) = plot.subplots(1, 2, figsize=(12, 5), layout="constrained")
picture.imshow(shown)
picture.set_axis_off()
picture.set_title(f"{scene_name}, {technique}")
bars.barh([name for name, _ in ran[-15:]], [ms for _, ms in ran[-15:]])
bars.set_xlabel("ms on the device")
figure.savefig("frame.png")
print(f"frame.png: {frame.gpu_ms:.1f} ms on the device, {frame.host_ms:.1f} ms of the call")
