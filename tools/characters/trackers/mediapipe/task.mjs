// The Face Landmarker of npm's @mediapipe/tasks-vision with a model of the user: 478 points, 52
// shapes.
import {FaceLandmarker, FilesetResolver} from '/package/vision_bundle.mjs';

/** A function that finds {points, shapes} of a picture (ImageData), points as those of mesh.mjs. */
export async function open(settings) {
  const files = await FilesetResolver.forVisionTasks('/package/wasm');
  const making = FaceLandmarker.createFromOptions(files, {
    baseOptions: {modelAssetPath: '/model', delegate: 'CPU'},
    runningMode: 'IMAGE',  // each picture for itself: nothing is smoothed or led over
    numFaces: 1,
    minFaceDetectionConfidence: settings.confidence,
    outputFaceBlendshapes: settings.shapes,
  });
  const landmarker = await making.catch((error) => {
    throw new Error('the model is no face_landmarker.task, or of another version: ' +
        error.message.split('\n')[0]);
  });
  return async (picture) => {
    const found = landmarker.detect(picture);
    return {
      points: found.faceLandmarks[0] ?? null,
      shapes: found.faceBlendshapes?.[0]?.categories.filter((shape) =>
          shape.categoryName !== '_neutral'),
    };
  };
}
