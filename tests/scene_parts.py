"""Scenes that differ a little, and files that walls of any shape are made from."""
import copy
import math
import struct


def changed(scene, **pointers):
    scene = copy.deepcopy(scene)
    for pointer, value in pointers.items():
        *path, last = pointer.split("__")
        place = scene
        for key in path:
            place = place[int(key) if key.isdigit() else key]
        place[int(last) if isinstance(place, list) else last] = value
    return scene


def tube_stl(radius, length, around=96, lids=True):
    """A tube along x in binary STL."""
    ring = [(radius * math.cos(2 * math.pi * i / around), radius * math.sin(2 * math.pi * i / around)) for i in range(around)]
    triangles = []
    for (y, z), (v, w) in zip(ring, ring[1:] + ring[:1]):
        triangles += [((0, y, z), (0, v, w), (length, y, z)), ((0, v, w), (length, v, w), (length, y, z))]
        if lids:
            triangles += [((length, 0, 0), (length, y, z), (length, v, w)), ((0, 0, 0), (0, v, w), (0, y, z))]
    faces = b"".join(struct.pack("<12fH", 0, 0, 0, *a, *b, *c, 0) for a, b, c in triangles)
    return bytes(80) + struct.pack("<I", len(triangles)) + faces
