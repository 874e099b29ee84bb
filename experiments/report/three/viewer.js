export {
  AmbientLight, BufferAttribute, BufferGeometry, Color, DirectionalLight, LineBasicMaterial, LineSegments, Mesh,
  MeshLambertMaterial, OrthographicCamera, Points, PointsMaterial, Scene, Vector3, WebGLRenderer,
} from "three";
export { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
