// What live heads do with news of lines, whether they speak lines or follow a voice.
#pragma once

#include "tools/speech/talking/line_events.h"
#include "tools/speech/talking/lines.h"
#include "tools/speech/talking/talking_face.h"

namespace animeme::speech {

/// The event of news of the kinds queued, cancelled, stopped, dropped, paused and resumed. `time`:
/// seconds, presentation time.
LineEvent event_of(const LineNews& news, double time);

/// Applies news that are for the face: look, activity, hear and mood. False: they are of other
/// kinds, and nothing was done.
bool direct_face(TalkingFace& face, const LineNews& news);

}  // namespace animeme::speech
