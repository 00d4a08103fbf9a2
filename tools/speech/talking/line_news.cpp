#include "tools/speech/talking/line_news_internal.h"

namespace animeme::speech {

LineEvent event_of(const LineNews& news, double time) {
  LineEvent event{.time = time, .line = news.line, .id = news.id};
  switch (news.what) {
    case LineNews::What::stopped:
      return {.what = LineEvent::What::stopped, .time = time};
    case LineNews::What::dropped:
      return {.what = LineEvent::What::dropped, .time = time};
    case LineNews::What::paused:
      return {.what = LineEvent::What::paused, .time = time};
    case LineNews::What::resumed:
      return {.what = LineEvent::What::resumed, .time = time};
    case LineNews::What::cancelled:
      event.what = LineEvent::What::cancelled;
      event.why = news.why;
      if (news.mark) event.line = 0;
      return event;
    default:
      event.what = LineEvent::What::queued;
      event.text = news.text;
      return event;
  }
}

bool direct_face(TalkingFace& face, const LineNews& news) {
  switch (news.what) {
    case LineNews::What::look:
      face.look(news.target);
      return true;
    case LineNews::What::activity:
      face.set_activity(news.activity);
      return true;
    case LineNews::What::hear:
      face.hear(news.voice);
      return true;
    case LineNews::What::mood:
      face.set_mood(news.mood);
      return true;
    default:
      return false;
  }
}

}  // namespace animeme::speech
