// A Vulkan 1.3 device: owners made from descriptions, one barrier, one way to run commands.
// Core features only: dynamic rendering, synchronization2, buffer addresses, scalar layout. It contains no geometry.
//
// Nothing of one Device may be called from two threads at once; each of two devices may be a thread's own. A Device
// must outlive everything that was made with it. Errors are Failure::device unless stated otherwise.
#pragma once

#include "gpu/device.h"
#include "gpu/memory.h"
#include "gpu/owned.h"
#include "gpu/pipeline.h"
#include "gpu/queries.h"
#include "gpu/swapchain.h"
