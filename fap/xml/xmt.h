/// @file
/// Faces in XMT-A, the XML form of MPEG-4 scenes: feature points, meshes, and tables of their
/// motion by FAPs (FDP with faceSceneGraph and faceDefTables).
///
///     animeme::Result<animeme::head::Source> source = animeme::head::read_xmt(text);
///     animeme::head::Head head = *animeme::head::assemble(std::move(*source));  // own_head.h
///
///     std::string text = *animeme::head::write_xmt(head, rig);
///
/// Source: ISO/IEC 14496-1 (nodes and their fields), fap/semantics.md, section 7. fap/xml/README.md
/// describes the meaning of the numbers, and what could not be checked against the text of the
/// standard.
#pragma once

#include "fap/head/own_head.h"
#include "fap/head/rig.h"

namespace animeme::head {

/// Reads the first FDP node of a scene.
///
/// Pieces are the IndexedFaceSets of faceSceneGraph, placed by their Transforms. The 84 positions
/// of featurePointsCoord, in the order of the standard, become the nearest vertices; 7.1 is the
/// neck pivot; positions that are farther from any vertex than a tenth of the pupil distance, or
/// beyond 1e30, are ignored. FAPU are measured on the positions. FaceDefMesh becomes a target for
/// each interval, in units of FAPU/1024; one interval is linear for all values. FaceDefTransform
/// turns or shifts the nodes below its Transform; those of eyes, neck and jaw define the pivots.
/// Teeth, tongue and eyeballs that are named as such are left to the rig. Not used: tables of FAP 1
/// and 2, scales, textures, FIT; Source::notes lists them.
///
/// Errors, with the line: syntax (not XML, numbers that do not match), out_of_range (invalid
/// indices, fapID, size limits), not_found (no FDP, no mesh, no feature points for FAPU),
/// unsupported (XML entities).
Result<Source> read_xmt(std::string_view text);

/// Writes a scene with one Face: all feature points (missing ones at 3.4e38), a Shape for each part
/// with colours, and tables for FAP 3..68. Linear motion is one interval; lids, which slide over
/// the eyes, have three. Lengths are cm with four digits, so positions are exact to 0.1 mm. Errors:
/// invalid_argument (a head without a feature point on its skin or without FAPU; a rig of another
/// head), and those of fap::measure_fapu(): readers derive FAPU from the points alone.
Result<std::string> write_xmt(const Head& head, const Rig& rig);

}  // namespace animeme::head
