"""kubernetes.py [--json] FILE: is a Job what it has to be, by rules of our own? Prints its command,
or all as JSON."""
import json
import sys

import yaml

job = yaml.safe_load(open(sys.argv[-1]))
spec, pod = job["spec"], job["spec"]["template"]["spec"]
container = pod["containers"][0]


def require(true, sentence):
    if not true:
        sys.exit(f"{sys.argv[-1]}: {sentence}")


require(job["apiVersion"] == "batch/v1" and job["kind"] == "Job", "is no Job of batch/v1")
require(job["metadata"]["name"], "has no name")
require(pod["restartPolicy"] in ("Never", "OnFailure"),
    "a Job wants restartPolicy Never or OnFailure")
require(container["name"] and container["image"], "the container wants a name and an image")
require({m["name"] for m in container["volumeMounts"]} == {v["name"] for v in pod["volumes"]},
        "mounts and volumes are not the same")
environment = {e["name"]: e["value"] for e in container["env"]}
require(all(isinstance(value, str) for value in environment.values()), "values of env are texts")
require(environment["DATA"] == container["volumeMounts"][0]["mountPath"],
    "DATA is not where the volume is")
# The schema takes fields that there are not, as one that is misspelt.
known = {"completionMode", "completions", "parallelism", "backoffLimit", "template"}
require(set(spec) <= known, f"fields that a Job has not: {set(spec) - known}")
if "JOB_COMPLETION_INDEX" in container["args"][0]:
    require(spec["completionMode"] == "Indexed", "has no index without completionMode: Indexed")
    require(str(spec["completions"]) == environment["SHARDS"], "completions and SHARDS differ")
require(container["command"] == ["sh", "-c"] and len(container["args"]) == 1,
    "wants one text for sh -c")
print(json.dumps(job) if "--json" in sys.argv else container["args"][0])
