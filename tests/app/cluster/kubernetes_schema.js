// kubernetes_schema.js JOB.json: a Job of batch/v1 by the schema of Kubernetes, which
// kubernetes-models carries.
const {readFileSync} = require('fs');
const {Job} = require('kubernetes-models/batch/v1');

const job = JSON.parse(readFileSync(process.argv[2], 'utf8'));
new Job(job).validate();
// It has to find what is wrong, too.
job.spec.completions = 'eight';
let found = false;
try {
  new Job(job).validate();
} catch {
  found = true;
}
if (!found) throw new Error('the schema takes a number that is none');
