# YADE: the scenes lab and field. `run` starts it with a JSON file of settings; it writes result.json and end.csv.
import json
import math
import os
import resource
import sys
import time

from yade import *

with open(sys.argv[1]) as file:
    job = json.load(file)
lab, mu = job["scene"] == "lab", job["mu"]

# E and poisson (for YADE the ratio ks/kn) so that two equal spheres have scree's kn, ks, kr and rolling limit.
young = 0.5 * math.pi * job["modulus"]


def material(label, young, alpha_kr, eta):
    return O.materials.append(
        CohFrictMat(label=label, young=young, poisson=1.0 / job["stiffness_ratio"], density=job["density"],
                    frictionAngle=math.atan(mu), isCohesive=False, momentRotationLaw=True, alphaKr=alpha_kr,
                    alphaKtw=0, etaRoll=eta))


rock = material("rock", young, 0.25, 0.5 * mu)
# YADE averages harmonically and takes the smaller rolling limit: a stiff wall gives 2 kn of an equal pair.
wall = material("wall", 1e3 * young, 1e3, 1e3)

WALLS = 3  # bodies with this mask do not look for each other


def facet(*corners):
    body = utils.facet(corners, material=wall)
    body.mask = WALLS
    return O.bodies.append(body)


particles = 0
with open(job["packing"]) as file:
    next(file)
    for line in file:
        x, y, z, d, fixed = (float(v) for v in line.split(","))
        body = utils.sphere((x, y, z), 0.5 * d, material=rock, fixed=bool(fixed))
        if fixed:
            body.mask = WALLS
        particles += not fixed
        O.bodies.append(body)
spheres = len(O.bodies)

lifted = []
if lab:
    n, r, h = 64, 0.175, 0.6
    ring = [(r * math.cos(2 * math.pi * k / n), r * math.sin(2 * math.pi * k / n)) for k in range(n + 1)]
    for a, b in zip(ring, ring[1:]):
        lifted.append(facet((*a, 0), (*b, 0), (*b, h)))
        lifted.append(facet((*a, 0), (*b, h), (*a, h)))
    facet((-20, -20, 0), (20, -20, 0), (0, 20, 0))
else:
    # One large facet each: facets that meet in a plane would press a sphere on their common edge twice.
    facet((-30, -60, 44), (60, 0, -46), (-30, 60, 44))
    facet((-60, -100, 0), (-60, 100, 0), (150, 0, 0))

O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Facet_Aabb()], verletDist=job["verlet_distance"],
                          targetInterv=job["target_interval"], avoidSelfInteractionMask=2),
    # The incremental law needs no total rotations, so they are not kept.
    InteractionLoop([Ig2_Sphere_Sphere_ScGeom6D(updateRotations=False), Ig2_Facet_Sphere_ScGeom6D()],
                    [Ip2_CohFrictMat_CohFrictMat_CohFrictPhys()],
                    [Law2_ScGeom6D_CohFrictPhys_CohesionMoment(useIncrementalForm=True, always_use_moment_law=True)]),
] + ([TranslationEngine(ids=lifted, translationAxis=(0, 0, 1), velocity=0.5)] if lab else []) + [
    NewtonIntegrator(damping=job["local_damping"], gravity=(0, 0, -9.81)),
]
O.dt = job["step"]


def cpu_seconds():
    used = resource.getrusage(resource.RUSAGE_SELF)
    return used.ru_utime + used.ru_stime


cpu, wall_clock, done = cpu_seconds(), time.time(), 0
while done < job["steps"] and cpu_seconds() - cpu < job["budget"]:
    chunk = min(job["chunk"], job["steps"] - done)
    O.run(chunk, True)
    done += chunk
result = {"particles": particles, "steps": done, "cpu_s": cpu_seconds() - cpu, "wall_s": time.time() - wall_clock}

with open(os.path.join(job["dir"], "end.csv"), "w") as file:
    file.write("x_m,y_m,z_m,diameter_m,fixed\n")
    for k in range(spheres):
        body = O.bodies[k]
        if body.mask != WALLS:
            file.write("%.6g,%.6g,%.6g,%.6g,0\n" % (*body.state.pos, 2 * body.shape.radius))
with open(os.path.join(job["dir"], "result.json"), "w") as file:
    json.dump(result, file)
os._exit(0)  # no prompt, no tear-down
