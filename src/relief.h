// All of relief: cages -> surfaces -> height maps -> models on a device -> pictures; and what it costs.
#pragma once

#include "animation/animation.h"
#include "bake/bake.h"
#include "base/base.h"
#include "cage/cage.h"
#include "check/check.h"
#include "displacement/displacement.h"
#include "distance/distance.h"
#include "frame/frame.h"
#include "gpu/gpu.h"
#include "measure/measure.h"
#include "mesh/mesh.h"
#include "model/model.h"
#include "pose/pose.h"
#include "scene/scene.h"
#include "surface/surface.h"
#include "triangles/triangles.h"
