// One drawing function per kind of figure.
#pragma once

#include "picture/panels.h"

namespace bentaxis::report::picture {

// @param page  the page's curves, which a figure may name
Picture picture_of(const ChannelFigure& figure, const Curves& page);
Picture picture_of(const PistonBars& figure, const Curves& page);
Picture picture_of(const OwnFigure& figure, const Curves& page);
Picture picture_of(const XyFigure& figure, const Curves& page);
Picture picture_of(const MapFigure& figure, const Curves& page);
Picture picture_of(const ScatterFigure& figure, const Curves& page);
Picture picture_of(const DrawingFigure& figure, const Curves& page);
Picture picture_of(const BarsFigure& figure, const Curves& page);
Picture picture_of(const BandFigure& figure, const Curves& page);
Picture picture_of(const ParallelFigure& figure, const Curves& page);

}  // namespace bentaxis::report::picture
