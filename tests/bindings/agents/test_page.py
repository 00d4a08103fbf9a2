"""The JavaScript of a page, with messages of FaceOutput."""
import asyncio
import base64
import json
import shutil
import subprocess
from pathlib import Path

import pytest

from conftest import SOURCE, RoomSound, frame_of
from face_output import FaceOutput
from livekit import rtc


@pytest.mark.skipif(shutil.which("node") is None, reason="node is missing (Debian: nodejs)")
def test_a_page_shows_what_is_heard(voice, tmp_path):
    samples, rate = voice

    async def talk():
        room = rtc.Room()
        sound = RoomSound(rate)
        face = FaceOutput(sound, room)
        for heard in [None, rate // 2, None]:
            for begin in range(0, len(samples), 2000):
                await face.capture_frame(frame_of(samples[begin:begin + 2000], rate))
            face.flush()
            await face.drained()
            sound.play(heard)
            if heard:
                face.clear_buffer()
            await face.wait_for_playout()
            await face.drained()
        await face.aclose()
        return room.local_participant.published

    lines = [json.dumps([topic, base64.b64encode(message).decode()]) for topic,
        message in asyncio.run(talk())]
    (tmp_path / "messages").write_text("\n".join(lines))
    done = subprocess.run(["node", Path(__file__).parent / "page_test.mjs", tmp_path / "messages",
                           SOURCE / "build/npm/tools/bindings/npm/package"], capture_output=True,
                           text=True)
    assert done.returncode == 0, done.stderr
    print(done.stdout)
