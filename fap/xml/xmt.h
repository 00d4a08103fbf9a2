/// @file
/// Faces in XMT-A, the XML form of MPEG-4 scenes: feature points, meshes, and tables of what each
/// FAP does to them (FDP with faceSceneGraph and faceDefTables).
///
///     animeme::Result<animeme::head::Source> source = animeme::head::read_xmt(text);
///     animeme::head::Head head = *animeme::head::assemble(std::move(*source));  // own_head.h
///
///     std::string text = *animeme::head::write_xmt(head, rig);
///
/// Source: ISO/IEC 14496-1 (nodes and their fields), fap/semantics.md, section 7. What their
/// numbers mean is told in the README, with what of it could not be checked against the text of the
/// standard.
#pragma once

#include "fap/head/own_head.h"
#include "fap/head/rig.h"

namespace animeme::head {

/// Reads the first FDP node of a scene.
///
/// Pieces are the IndexedFaceSets of faceSceneGraph, placed by their Transforms. The 84 places of
/// featurePointsCoord, in the order of the standard, become the nearest vertices; 7.1 is the pivot
/// of the neck; places that are farther than a tenth of the distance of the pupils from any vertex,
/// or beyond 1e30, are left out. FAPU are measured on the places. FaceDefMesh becomes a target for
/// each interval, in units of FAPU/1024; one interval is a straight move for all values.
/// FaceDefTransform turns or shifts what is below its Transform; those of eyes, neck and jaw tell
/// where these turn. Teeth, tongue and eyeballs that are named as such are left to our rig.
/// Not used: tables of FAP 1 and 2, scales, textures, FIT. Source::notes says so.
///
/// Errors, with the line: syntax (no XML, numbers that do not fit together), out_of_range (indices
/// that name nothing, fapID, limits of size), not_found (no FDP, no mesh, feature points that FAPU
/// need), unsupported (entities of XML).
Result<Source> read_xmt(std::string_view text);

/// Writes a scene with one Face: all feature points (those that the head does not have at 3.4e38),
/// a Shape for each part with colours, and tables for FAP 3..68. Straight moves are one interval;
/// lids, which slide over the eyes, have three. Lengths are cm with four digits, so places are good
/// to 0.1 mm.
/// Errors: invalid_argument (a head without a feature point on its skin or without FAPU; a rig of
/// another head), and those of fap::measure_fapu(): readers know FAPU from the points alone.
Result<std::string> write_xmt(const Head& head, const Rig& rig);

}  // namespace animeme::head
