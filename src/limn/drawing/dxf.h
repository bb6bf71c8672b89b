#pragma once

#include <string>

#include "limn/drawing/page.h"

namespace limn {

/// The page as a DXF drawing of AutoCAD 2000 (AC1015), in millimetres: one LWPOLYLINE a stroke, one layer a layer of
/// the page, hidden ones of linetype DASHED.
///
/// That version, because it is the oldest whose header can say that the units are millimetres and whose polylines are
/// single entities; every reader since knows it. Same page, same bytes: no dates, no names of people. Cost: one pass.
std::string dxf_text(const Page& page);

}  // namespace limn
