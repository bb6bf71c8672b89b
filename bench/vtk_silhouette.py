"""Times vtkPolyDataSilhouette for bench/extraction: what a user would pick today.

    vtk_silhouette.py MESH

MESH: two 64-bit counts, then positions as float32 triples and faces as uint32 triples. Prints "ready VERSION"; then for
each line "x y z" on standard input the milliseconds that one update from that viewpoint took, and the lines found.
"""

import sys
import time

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
from vtkmodules.vtkCommonCore import vtkPoints, vtkVersion
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkFiltersHybrid import vtkPolyDataSilhouette


def read_mesh(path):
    data = open(path, "rb").read()
    positions, faces = map(int, numpy.frombuffer(data, "<u8", 2))
    points = numpy.frombuffer(data, "<f4", 3 * positions, 16).reshape(-1, 3)
    triangles = numpy.frombuffer(data, "<u4", 3 * faces, 16 + 12 * positions).reshape(-1, 3)
    mesh = vtkPolyData()
    vtk_points = vtkPoints()
    vtk_points.SetData(numpy_to_vtk(points, deep=True))
    mesh.SetPoints(vtk_points)
    cells = numpy.insert(triangles.astype(numpy.int64), 0, 3, axis=1).ravel()
    polys = vtkCellArray()
    polys.SetCells(faces, numpy_to_vtkIdTypeArray(cells, deep=True))
    mesh.SetPolys(polys)
    return mesh


def main():
    silhouette = vtkPolyDataSilhouette()
    silhouette.SetInputData(read_mesh(sys.argv[1]))
    silhouette.SetDirectionToSpecifiedOrigin()
    silhouette.SetEnableFeatureAngle(0)
    silhouette.BorderEdgesOff()
    silhouette.PieceInvariantOff()
    silhouette.SetOrigin(10.0, 20.0, 30.0)
    silhouette.Update()  # the edges' table is built once, and not counted
    print("ready", vtkVersion.GetVTKVersion(), flush=True)
    for line in sys.stdin:
        silhouette.SetOrigin(*map(float, line.split()))
        start = time.perf_counter()
        silhouette.Update()
        spent_ms = 1e3 * (time.perf_counter() - start)
        print(spent_ms, silhouette.GetOutput().GetNumberOfLines(), flush=True)


main()
