<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" language="ja" sourcelanguage="en">
<context>
    <name>AttributeEditor</name>
    <message>
        <source>(several values)</source>
        <translation>（複数の値）</translation>
    </message>
    <message>
        <source>Empty this field of all selected features</source>
        <translation>選択したすべての地物でこの項目を空にします</translation>
    </message>
    <message>
        <source>YYYY-MM-DD</source>
        <translation>YYYY-MM-DD</translation>
    </message>
</context>
<context>
    <name>AttributeForm</name>
    <message numerus="yes">
        <source>%n feature(s)</source>
        <translation>
            <numerusform>%n 個の地物</numerusform>
        </translation>
    </message>
    <message>
        <source>Kind</source>
        <translation>種別</translation>
    </message>
    <message>
        <source>Status</source>
        <translation>状態</translation>
    </message>
    <message>
        <source>(several kinds)</source>
        <translation>（複数の種別）</translation>
    </message>
    <message>
        <source>(several values)</source>
        <translation>（複数の値）</translation>
    </message>
    <message>
        <source>Confidence</source>
        <translation>信頼度</translation>
    </message>
    <message>
        <source>Choose the sign&apos;s number by the shape of its plate (Alt+Down)</source>
        <translation>標識番号を板の形から選択します（Alt+Down）</translation>
    </message>
</context>
<context>
    <name>AttributePanel</name>
    <message>
        <source>Choose a feature to see what is known about it.</source>
        <translation>地物を選択すると、その属性を表示します。</translation>
    </message>
</context>
<context>
    <name>CameraBar</name>
    <message>
        <source>The image before in the list (Page Up or [)</source>
        <translation>一覧の前の画像（Page Up または [）</translation>
    </message>
    <message>
        <source>The next image in the list (Page Down or ])</source>
        <translation>一覧の次の画像（Page Down または ]）</translation>
    </message>
    <message>
        <source>The images that see the place, best first</source>
        <translation>この場所が写っている画像（見やすい順）</translation>
    </message>
    <message>
        <source>Stereo</source>
        <translation>ステレオ</translation>
    </message>
    <message>
        <source>Measure a place by two images where points are missing</source>
        <translation>点のない場所を2枚の画像で計測します</translation>
    </message>
    <message>
        <source>Calibration</source>
        <translation>標定調整</translation>
    </message>
    <message>
        <source>Adjust how the camera sits on the vehicle</source>
        <translation>車両に対するカメラの取り付けを調整します</translation>
    </message>
    <message>
        <source>{number}/{count}  {name} · {distance} m</source>
        <translation>{number}/{count}  {name} · {distance} m</translation>
    </message>
    <message>
        <source>{number}/{count}  {name} · {distance} m (hidden)</source>
        <translation>{number}/{count}  {name} · {distance} m（隠れ）</translation>
    </message>
    <message>
        <source>No image</source>
        <translation>画像なし</translation>
    </message>
</context>
<context>
    <name>CameraView</name>
    <message>
        <source>There are no camera images. Add the list of a drive&apos;s images (File ▸ Add camera images).</source>
        <translation>カメラ画像がありません。走行データの画像一覧を追加してください（ファイル ▸ カメラ画像を追加）。</translation>
    </message>
    <message>
        <source>Click a place in another view to see it in the camera images.</source>
        <translation>別のビューで場所をクリックすると、その場所のカメラ画像を表示します。</translation>
    </message>
    <message>
        <source>No image sees this place. The nearest one, {name}, was taken {distance} m away.</source>
        <translation>この場所が写っている画像はありません。最も近い画像 {name} の撮影位置まで {distance} m です。</translation>
    </message>
    <message>
        <source>Fade what is hidden in the image</source>
        <translation>画像で隠れている地物を薄く表示</translation>
    </message>
    <message>
        <source>Reading {name} …</source>
        <translation>{name} を読み込み中…</translation>
    </message>
    <message>
        <source>Something hides the place in this image.</source>
        <translation>この画像では、この場所が手前のものに隠れています。</translation>
    </message>
</context>
<context>
    <name>CandidateCard</name>
    <message>
        <source>Decided: {status}</source>
        <translation>判定: {status}</translation>
    </message>
    <message>
        <source>Found by</source>
        <translation>検出ツール</translation>
    </message>
</context>
<context>
    <name>CatalogueWish</name>
    <message>
        <source>Use an office&apos;s catalogue</source>
        <translation>事務所のカタログを使う</translation>
    </message>
    <message>
        <source>The map uses kinds that the file doesn&apos;t have. Keep them with it?</source>
        <translation>図面で使用中の種別がこのファイルにありません。その種別を残して使用しますか。</translation>
    </message>
    <message>
        <source>Keep them</source>
        <translation>残して使用</translation>
    </message>
</context>
<context>
    <name>ClassChips</name>
    <message>
        <source>More classes</source>
        <translation>他のクラス</translation>
    </message>
    <message>
        <source>Paint this class</source>
        <translation>このクラスで塗ります</translation>
    </message>
</context>
<context>
    <name>ClassPanel</name>
    <message>
        <source>Show right and wrong</source>
        <translation>正誤を表示</translation>
    </message>
    <message>
        <source>Colours the points in all views by what the chosen run did with them</source>
        <translation>選択した実行結果の正誤を、すべてのビューで点の色で表示します</translation>
    </message>
    <message>
        <source>Export</source>
        <translation>書き出し</translation>
    </message>
    <message>
        <source>Table (CSV)</source>
        <translation>表（CSV）</translation>
    </message>
    <message>
        <source>{tool}: as it stands now</source>
        <translation>{tool}: 現在の状態</translation>
    </message>
    <message>
        <source>{tool}: if nothing were removed</source>
        <translation>{tool}: 何も除去しない場合</translation>
    </message>
    <message>
        <source>{tool}: if everything were kept</source>
        <translation>{tool}: すべて残す場合</translation>
    </message>
    <message>
        <source>Positive is the point that is kept: no noise; ground</source>
        <translation>正例は残す点です（ノイズでない点・地面）</translation>
    </message>
    <message>
        <source>Positive is the point that is removed: noise; an object on the ground</source>
        <translation>正例は取り除く点です（ノイズ・地物）</translation>
    </message>
    <message>
        <source>Of the points called so, the share that is</source>
        <translation>そう判定した点のうち、実際にそうである点の割合</translation>
    </message>
    <message>
        <source>Of the points that are so, the share that is called so</source>
        <translation>実際にそうである点のうち、そう判定した点の割合</translation>
    </message>
    <message>
        <source>Harmonic mean of precision and recall</source>
        <translation>適合率と再現率の調和平均</translation>
    </message>
    <message>
        <source>Tool and run</source>
        <translation>ツールと実行</translation>
    </message>
    <message>
        <source>Kept:
precision</source>
        <translation>残す点
適合率</translation>
    </message>
    <message>
        <source>Kept:
recall</source>
        <translation>残す点
再現率</translation>
    </message>
    <message>
        <source>Kept:
F</source>
        <translation>残す点
F値</translation>
    </message>
    <message>
        <source>Removed:
precision</source>
        <translation>除去点
適合率</translation>
    </message>
    <message>
        <source>Removed:
recall</source>
        <translation>除去点
再現率</translation>
    </message>
    <message>
        <source>Removed:
F</source>
        <translation>除去点
F値</translation>
    </message>
    <message>
        <source>Kappa</source>
        <translation>κ係数</translation>
    </message>
    <message>
        <source>Agreement beyond chance</source>
        <translation>偶然の一致を除いた一致度</translation>
    </message>
    <message>
        <source>Wrongly
removed</source>
        <translation>誤除去</translation>
    </message>
    <message>
        <source>Points that should have been kept</source>
        <translation>残すべきなのに除去した点数</translation>
    </message>
    <message>
        <source>Wrongly
kept</source>
        <translation>取り残し</translation>
    </message>
    <message>
        <source>Points that should have been removed</source>
        <translation>除去すべきなのに残した点数</translation>
    </message>
    <message>
        <source>Points</source>
        <translation>点数</translation>
    </message>
    <message>
        <source>Points whose truth is known</source>
        <translation>正解の分かっている点数</translation>
    </message>
    <message>
        <source>rightly kept</source>
        <translation>正しく残した点</translation>
    </message>
    <message>
        <source>rightly removed</source>
        <translation>正しく除去した点</translation>
    </message>
    <message>
        <source>wrongly removed</source>
        <translation>誤って除去した点</translation>
    </message>
    <message>
        <source>wrongly kept</source>
        <translation>取り残した点</translation>
    </message>
    <message>
        <source>Say first what is true: paint, check, then “New truth”.</source>
        <translation>先に正解を登録してください（ラベルを付けて確認し、「正解を登録」）。</translation>
    </message>
    <message>
        <source>kept: {kept}; removed: {removed}</source>
        <translation>残す点: {kept}、除去点: {removed}</translation>
    </message>
    <message>
        <source>Run a tool that gives classes on the drive of this truth.</source>
        <translation>この正解の走行データで、点を分類する処理を実行してください。</translation>
    </message>
</context>
<context>
    <name>ClassWiring</name>
    <message>
        <source>Make a truth on the page of point classes first.</source>
        <translation>先に「点のクラス」のページで正解を登録してください。</translation>
    </message>
    <message>
        <source>Take the truth from a file</source>
        <translation>ファイルから正解を登録</translation>
    </message>
    <message>
        <source>Forget a truth</source>
        <translation>正解の削除</translation>
    </message>
    <message>
        <source>The truth is removed from the project for good. Forget it?</source>
        <translation>正解をプロジェクトから完全に削除します。よろしいですか？</translation>
    </message>
    <message>
        <source>Forget it</source>
        <translation>削除する</translation>
    </message>
</context>
<context>
    <name>ColumnsForm</name>
    <message>
        <source>Columns of the points</source>
        <translation>点群の列</translation>
    </message>
    <message>
        <source>Import</source>
        <translation>インポート</translation>
    </message>
    <message>
        <source>Choose the columns of {names}.</source>
        <translation>{names} の列を選んでください。</translation>
    </message>
    <message>
        <source>Two columns have the same name.</source>
        <translation>同じ名前の列が2つあります。</translation>
    </message>
</context>
<context>
    <name>CommandPalette</name>
    <message>
        <source>Commands</source>
        <translation>コマンド</translation>
    </message>
    <message>
        <source>Type part of a name, or a key such as F9</source>
        <translation>名前の一部、またはF9などのキーを入力</translation>
    </message>
</context>
<context>
    <name>CompareRunsForm</name>
    <message>
        <source>Compare runs</source>
        <translation>実行結果の比較</translation>
    </message>
    <message>
        <source>Keep this run</source>
        <translation>この結果を残す</translation>
    </message>
    <message>
        <source>{count} candidates, {alone} of them only here</source>
        <translation>候補{count}件、うちこの結果だけのもの{alone}件</translation>
    </message>
</context>
<context>
    <name>ConfidenceBar</name>
    <message>
        <source>Confidence: how sure the tool is of it, 0 to 1</source>
        <translation>信頼度: ツールの確信の度合い（0～1）</translation>
    </message>
</context>
<context>
    <name>DeliveryTable</name>
    <message>
        <source>File</source>
        <translation>ファイル</translation>
    </message>
    <message>
        <source>Kind</source>
        <translation>種類</translation>
    </message>
    <message>
        <source>Number</source>
        <translation>数量</translation>
    </message>
    <message>
        <source>Extent</source>
        <translation>範囲</translation>
    </message>
    <message>
        <source>Scanner</source>
        <translation>スキャナ</translation>
    </message>
    <message>
        <source>Time</source>
        <translation>計測時間</translation>
    </message>
    <message>
        <source>Reference system</source>
        <translation>座標参照系</translation>
    </message>
    <message>
        <source>Trajectory</source>
        <translation>走行軌跡</translation>
    </message>
</context>
<context>
    <name>DensityView</name>
    <message>
        <source>Road, {side} m to the left: {density} points/m², {gap} cm between points</source>
        <translation>路面、左へ{side} m: {density} 点/m²、点間隔 {gap} cm</translation>
    </message>
    <message>
        <source>Road, {side} m to the right: {density} points/m², {gap} cm between points</source>
        <translation>路面、右へ{side} m: {density} 点/m²、点間隔 {gap} cm</translation>
    </message>
    <message>
        <source>Wall {side} m to the left, {up} m up: {density} points/m²</source>
        <translation>左へ{side} mの壁、高さ{up} m: {density} 点/m²</translation>
    </message>
    <message>
        <source>Wall {side} m to the right, {up} m up: {density} points/m²</source>
        <translation>右へ{side} mの壁、高さ{up} m: {density} 点/m²</translation>
    </message>
    <message>
        <source>Here the vehicle drives.</source>
        <translation>車両の走行位置です。</translation>
    </message>
    <message>
        <source>Walls along the road, by distance and height</source>
        <translation>道路沿いの壁（距離と高さ）</translation>
    </message>
    <message>
        <source>Road, by distance from the vehicle</source>
        <translation>路面（車両からの距離）</translation>
    </message>
    <message>
        <source>points/m²</source>
        <translation>点/m²</translation>
    </message>
</context>
<context>
    <name>DrawingBar</name>
    <message>
        <source>What is drawn: choose by name (Ctrl+K) or number key</source>
        <translation>作図する種別。名前（Ctrl+K）または数字キーで選びます</translation>
    </message>
    <message>
        <source>What clicks snap to (Alt+1 to Alt+7)</source>
        <translation>クリックの吸着先（Alt+1～Alt+7で切替）</translation>
    </message>
    <message>
        <source>Distance of the parallel copy; 0: where the mouse is</source>
        <translation>平行複写の距離（0はマウスの位置）</translation>
    </message>
    <message>
        <source>How much higher the copy runs: the upper edge of a curb</source>
        <translation>複写線を高くする量（縁石の上端など）</translation>
    </message>
</context>
<context>
    <name>DriveActions</name>
    <message>
        <source>Add a trajectory</source>
        <translation>走行軌跡を追加</translation>
    </message>
    <message>
        <source>Add camera images</source>
        <translation>カメラ画像を追加</translation>
    </message>
    <message>
        <source>Replace by a new delivery</source>
        <translation>新しい納品データに差し替え</translation>
    </message>
</context>
<context>
    <name>DrivePropertiesForm</name>
    <message>
        <source>Properties of a drive</source>
        <translation>走行データのプロパティ</translation>
    </message>
    <message>
        <source>Name</source>
        <translation>名称</translation>
    </message>
    <message>
        <source>Measured on</source>
        <translation>計測日</translation>
    </message>
    <message>
        <source>unknown, for instance 2026-04-01</source>
        <translation>不明（例: 2026-04-01）</translation>
    </message>
    <message>
        <source>Trajectory…</source>
        <translation>走行軌跡…</translation>
    </message>
    <message>
        <source>Camera images…</source>
        <translation>カメラ画像…</translation>
    </message>
    <message>
        <source>Reference system…</source>
        <translation>座標参照系…</translation>
    </message>
    <message>
        <source>Replace by a new delivery…</source>
        <translation>新しい納品データに差し替え…</translation>
    </message>
    <message>
        <source>Remove from the project</source>
        <translation>プロジェクトから除く</translation>
    </message>
</context>
<context>
    <name>EmptyPage</name>
    <message>
        <source>A recording is shown here as an image: every pixel is a laser point.</source>
        <translation>ここに計測データを画像として表示します。画素はすべてレーザ点です。</translation>
    </message>
    <message>
        <source>Import a delivery…</source>
        <translation>納品データをインポート…</translation>
    </message>
    <message>
        <source>Open a project…</source>
        <translation>プロジェクトを開く…</translation>
    </message>
</context>
<context>
    <name>EvaluationPanel</name>
    <message>
        <source>Against what was drawn and accepted, place by place:</source>
        <translation>作図・採用した地物との区間ごとの比較:</translation>
    </message>
    <message>
        <source>{what}: precision {p}, recall {r}, F {f}</source>
        <translation>{what}: 適合率 {p}、再現率 {r}、F値 {f}</translation>
    </message>
    <message numerus="yes">
        <source>%n run(s)</source>
        <translation>
            <numerusform>実行%n件</numerusform>
        </translation>
    </message>
    <message>
        <source>Tool and run</source>
        <translation>ツールと実行</translation>
    </message>
    <message>
        <source>Precision</source>
        <translation>適合率</translation>
    </message>
    <message>
        <source>Accepted of all decided, with the 95 % interval</source>
        <translation>判定済みのうち採用の割合（95%信頼区間）</translation>
    </message>
    <message>
        <source>Recall</source>
        <translation>再現率</translation>
    </message>
    <message>
        <source>Accepted of accepted and drawn by hand, with the 95 % interval</source>
        <translation>採用と手作図の合計に占める採用の割合（95%信頼区間）</translation>
    </message>
    <message>
        <source>Accepted</source>
        <translation>採用</translation>
    </message>
    <message>
        <source>As they were found, or corrected</source>
        <translation>検出のまま、または修正して採用したもの</translation>
    </message>
    <message>
        <source>Rejected</source>
        <translation>却下</translation>
    </message>
    <message>
        <source>Undecided</source>
        <translation>未判定</translation>
    </message>
    <message>
        <source>Candidates that nobody has judged</source>
        <translation>まだ判定されていない候補</translation>
    </message>
    <message>
        <source>Drawn by hand</source>
        <translation>手作図</translation>
    </message>
    <message>
        <source>Features of the same kinds on the same drives that the tool missed</source>
        <translation>同じ走行データ上の同じ種別で、ツールが見つけず手で描いた地物</translation>
    </message>
    <message>
        <source>Recall by length</source>
        <translation>再現率（延長）</translation>
    </message>
    <message>
        <source>The same in metres, for lines</source>
        <translation>線について延長で求めた再現率</translation>
    </message>
    <message>
        <source>Corrected</source>
        <translation>修正</translation>
    </message>
    <message>
        <source>Accepted after they were changed</source>
        <translation>修正してから採用したもの</translation>
    </message>
    <message>
        <source>Mean shift</source>
        <translation>平均移動量</translation>
    </message>
    <message>
        <source>How far the vertices of corrected features lie from where they were found</source>
        <translation>修正した地物の頂点と検出位置との平均距離</translation>
    </message>
    <message>
        <source>Calibration error</source>
        <translation>較正誤差</translation>
    </message>
    <message>
        <source>How far the share accepted is from the confidence, on average</source>
        <translation>採用の割合と信頼度との差の平均</translation>
    </message>
    <message>
        <source>Table (CSV)</source>
        <translation>表（CSV）</translation>
    </message>
    <message>
        <source>Curve (PNG)</source>
        <translation>グラフ（PNG）</translation>
    </message>
    <message>
        <source>Curve (PDF)</source>
        <translation>グラフ（PDF）</translation>
    </message>
    <message>
        <source>Export</source>
        <translation>書き出し</translation>
    </message>
    <message>
        <source>Once candidates of a run are judged, this says how good the tool was.</source>
        <translation>候補を判定すると、ここにツールの評価が表示されます。</translation>
    </message>
    <message>
        <source>Confidence of the tool</source>
        <translation>ツールの信頼度</translation>
    </message>
    <message>
        <source>Share accepted</source>
        <translation>採用の割合</translation>
    </message>
    <message>
        <source>{count} decided</source>
        <translation>判定済み{count}件</translation>
    </message>
    <message>
        <source>calibration error {error}</source>
        <translation>較正誤差{error}</translation>
    </message>
    <message>
        <source>Nothing is decided yet.</source>
        <translation>まだ判定がありません。</translation>
    </message>
</context>
<context>
    <name>ExistingMapForm</name>
    <message>
        <source>Existing map</source>
        <translation>既存図</translation>
    </message>
    <message>
        <source>Compares a map that was delivered before with what is accepted and drawn, kind by kind in plan, or takes its features in.</source>
        <translation>納品済みの図面を、採用・作図済みの地物と種別ごとに平面位置で比較するか、地物として取り込みます。</translation>
    </message>
</context>
<context>
    <name>ExportForm</name>
    <message>
        <source>Export</source>
        <translation>書き出し</translation>
    </message>
    <message>
        <source>Unchecked candidates as well</source>
        <translation>未確認の候補も含める</translation>
    </message>
    <message>
        <source>Choose…</source>
        <translation>選択…</translation>
    </message>
    <message>
        <source>Files</source>
        <translation>ファイル</translation>
    </message>
    <message>
        <source>Folder</source>
        <translation>フォルダ</translation>
    </message>
</context>
<context>
    <name>FeatureFilter</name>
    <message>
        <source>Search</source>
        <translation>検索</translation>
    </message>
    <message>
        <source>Words in kinds, layers, attributes; the beginning of an id</source>
        <translation>種別・レイヤ・属性に含まれる語、またはIDの先頭</translation>
    </message>
    <message>
        <source>Kind of the features</source>
        <translation>地物の種別</translation>
    </message>
    <message>
        <source>Status of the features</source>
        <translation>地物の状態</translation>
    </message>
    <message>
        <source>Occluded</source>
        <translation>点なし頂点あり</translation>
    </message>
    <message>
        <source>Only features that have vertices without a measured point</source>
        <translation>計測点のない頂点をもつ地物だけを表示します</translation>
    </message>
    <message>
        <source>Attribute that is compared</source>
        <translation>条件にする属性</translation>
    </message>
    <message>
        <source>How the attribute is compared</source>
        <translation>属性の比較方法</translation>
    </message>
    <message>
        <source>Value</source>
        <translation>値</translation>
    </message>
    <message>
        <source>Select shown</source>
        <translation>表示中を選択</translation>
    </message>
    <message>
        <source>Select the features of all rows; with Shift in addition</source>
        <translation>表示中のすべての行の地物を選択します（Shiftで追加選択）</translation>
    </message>
    <message>
        <source>All kinds</source>
        <translation>すべての種別</translation>
    </message>
    <message>
        <source>{shown} of {total} features shown</source>
        <translation>{total}個中{shown}個の地物を表示</translation>
    </message>
    <message>
        <source>Any status</source>
        <translation>すべての状態</translation>
    </message>
    <message>
        <source>Any attribute</source>
        <translation>属性条件なし</translation>
    </message>
</context>
<context>
    <name>FeatureMenu</name>
    <message>
        <source>Go there</source>
        <translation>この地物へ移動</translation>
    </message>
    <message>
        <source>Select all of this kind</source>
        <translation>同じ種別をすべて選択</translation>
    </message>
    <message>
        <source>Accept</source>
        <translation>採用</translation>
    </message>
    <message>
        <source>Reject</source>
        <translation>却下</translation>
    </message>
    <message>
        <source>Make a candidate</source>
        <translation>候補に戻す</translation>
    </message>
    <message>
        <source>Delete</source>
        <translation>削除</translation>
    </message>
    <message>
        <source>Change kind to</source>
        <translation>種別の変更</translation>
    </message>
</context>
<context>
    <name>FeatureTable</name>
    <message>
        <source>No feature fits the filter.</source>
        <translation>条件に合う地物はありません。</translation>
    </message>
    <message>
        <source>Features appear here once something is drawn.</source>
        <translation>作図すると、ここに地物の一覧が表示されます。</translation>
    </message>
</context>
<context>
    <name>FileActions</name>
    <message>
        <source>Open project</source>
        <translation>プロジェクトを開く</translation>
    </message>
    <message>
        <source>Find delivered files</source>
        <translation>納品ファイルの場所を指定</translation>
    </message>
    <message>
        <source>Use an office&apos;s catalogue</source>
        <translation>事務所のカタログを使う</translation>
    </message>
    <message>
        <source>Write the catalogue</source>
        <translation>カタログの書き出し</translation>
    </message>
</context>
<context>
    <name>ImageBar</name>
    <message>
        <source>Darker end of the contrast, percentile</source>
        <translation>コントラストの暗い側（百分位数）</translation>
    </message>
    <message>
        <source>Brighter end of the contrast, percentile</source>
        <translation>コントラストの明るい側（百分位数）</translation>
    </message>
    <message>
        <source>Show another image beside this one</source>
        <translation>画像をもう1つ並べて表示</translation>
    </message>
    <message>
        <source>Whole</source>
        <translation>全体</translation>
    </message>
    <message>
        <source>Show the whole recording (Home)</source>
        <translation>計測データ全体を表示（Home）</translation>
    </message>
    <message>
        <source>One pixel of the image on one of the screen</source>
        <translation>画像の1画素を画面の1画素で表示</translation>
    </message>
    <message>
        <source>Contrast</source>
        <translation>コントラスト</translation>
    </message>
</context>
<context>
    <name>ImageClicks</name>
    <message>
        <source>Click a thing here, then the same one in another view.</source>
        <translation>ここで対象をクリックし、続けて別のビューで同じものをクリックしてください。</translation>
    </message>
    <message>
        <source>Stereo: click the thing in this image.</source>
        <translation>ステレオ: この画像で対象をクリックしてください。</translation>
    </message>
    <message>
        <source>Stereo: go to another image that shows the thing.</source>
        <translation>ステレオ: 同じ対象が写っている別の画像に移ってください。</translation>
    </message>
    <message>
        <source>Stereo: click the same thing on the line. Escape begins again.</source>
        <translation>ステレオ: 線の上で同じものをクリックしてください（Escで最初から）。</translation>
    </message>
</context>
<context>
    <name>ImageOrientation</name>
    <message>
        <source>Street from left to right</source>
        <translation>道路を左から右へ（横向き）</translation>
    </message>
    <message>
        <source>Street upwards</source>
        <translation>道路を上向きに表示</translation>
    </message>
    <message>
        <source>Exchange left and right sides</source>
        <translation>左右を反転</translation>
    </message>
    <message>
        <source>Against the direction of travel</source>
        <translation>進行方向を反転</translation>
    </message>
</context>
<context>
    <name>ImageView</name>
    <message>
        <source>Show everything</source>
        <translation>全体を表示</translation>
    </message>
    <message>
        <source>One pixel as one pixel</source>
        <translation>画像の1画素を画面の1画素で表示</translation>
    </message>
    <message>
        <source>Centre on the selection</source>
        <translation>選択位置を中央に表示</translation>
    </message>
    <message>
        <source>Direction of the street</source>
        <translation>道路の向き</translation>
    </message>
</context>
<context>
    <name>ImageViewSettings</name>
    <message>
        <source>Direction of travel in the image; exchange its sides</source>
        <translation>画像内の進行方向・左右反転</translation>
    </message>
</context>
<context>
    <name>ImportForm</name>
    <message>
        <source>Import a drive</source>
        <translation>走行データのインポート</translation>
    </message>
    <message>
        <source>Take the delivered classes as labels</source>
        <translation>納品時のクラスをラベルとして取り込む</translation>
    </message>
    <message>
        <source>Labels can be corrected by hand and are exported to LAS again.</source>
        <translation>ラベルは手動で修正でき、LASに書き出せます。</translation>
    </message>
    <message>
        <source>Import</source>
        <translation>インポート</translation>
    </message>
    <message>
        <source>Take the trajectory beside them: {name} covers their times</source>
        <translation>同じ場所にある走行軌跡 {name} も読み込む（計測時刻を含んでいます）</translation>
    </message>
    <message>
        <source>No trajectory is among the files. Curbs and covered gutters can&apos;t be found without one; it can be added to the drive later.</source>
        <translation>走行軌跡のファイルがありません。走行軌跡がないと縁石と蓋付き側溝を抽出できません。後から走行データに追加することもできます。</translation>
    </message>
    <message>
        <source>Add files…</source>
        <translation>ファイルを追加…</translation>
    </message>
    <message>
        <source>Remove</source>
        <translation>除外</translation>
    </message>
    <message>
        <source>Choose…</source>
        <translation>選択…</translation>
    </message>
    <message>
        <source>Point files of all scanners, the trajectory, and image lists if there are any.</source>
        <translation>全スキャナの点群ファイル、軌跡ファイルと、あれば画像一覧を指定してください。</translation>
    </message>
    <message>
        <source>Project</source>
        <translation>プロジェクト</translation>
    </message>
    <message>
        <source>Reference system</source>
        <translation>座標参照系</translation>
    </message>
    <message>
        <source>Add files</source>
        <translation>ファイルの追加</translation>
    </message>
    <message>
        <source>Zuka projects (*.zuka)</source>
        <translation>Zukaプロジェクト (*.zuka)</translation>
    </message>
    <message>
        <source>The reference system must be a code such as EPSG:6677, or be left empty.</source>
        <translation>座標参照系は EPSG:6677 のようなコードで指定するか、空欄にしてください。</translation>
    </message>
    <message>
        <source>Take the list of camera images beside them: {name}</source>
        <translation>同じ場所にあるカメラ画像一覧 {name} も読み込む</translation>
    </message>
    <message>
        <source>Add to the project beside them: {name}</source>
        <translation>同じ場所にあるプロジェクト {name} に追加する</translation>
    </message>
    <message>
        <source>Looking at the files…</source>
        <translation>ファイルを調べています…</translation>
    </message>
</context>
<context>
    <name>ImportOffer</name>
    <message>
        <source>Go on</source>
        <translation>再開</translation>
    </message>
    <message>
        <source>Discard</source>
        <translation>破棄</translation>
    </message>
    <message>
        <source>Add {name}</source>
        <translation>{name} を追加</translation>
    </message>
</context>
<context>
    <name>JobsPanel</name>
    <message>
        <source>Jobs appear here while they run.</source>
        <translation>実行中のジョブがここに表示されます。</translation>
    </message>
</context>
<context>
    <name>LabelPanel</name>
    <message>
        <source>Show the labels</source>
        <translation>ラベルを表示</translation>
    </message>
    <message>
        <source>Brush radius</source>
        <translation>ブラシ半径</translation>
    </message>
    <message>
        <source>Paint over</source>
        <translation>塗る対象</translation>
    </message>
    <message>
        <source>In space; the keys [ and ] change it too.</source>
        <translation>空間上の半径です。[ と ] キーでも変更できます。</translation>
    </message>
    <message>
        <source>Other points stay as they are, whatever is dragged over.</source>
        <translation>対象以外の点は、なぞっても変わりません。</translation>
    </message>
    <message>
        <source>All points</source>
        <translation>すべての点</translation>
    </message>
    <message>
        <source>Points without a label</source>
        <translation>ラベルのない点</translation>
    </message>
    <message>
        <source>Only {name}</source>
        <translation>{name}のみ</translation>
    </message>
    <message>
        <source>No label (erase)</source>
        <translation>ラベルなし（消去）</translation>
    </message>
    <message>
        <source>Points of this class: {labelled} by labels, {delivered} as delivered</source>
        <translation>このクラスの点数（ラベル {labelled}、納品時のまま {delivered}）</translation>
    </message>
    <message>
        <source>Key that takes this class, with a paint tool in hand</source>
        <translation>ラベルを塗るツールの使用中にこのクラスを選ぶキー</translation>
    </message>
</context>
<context>
    <name>LayersPanel</name>
    <message>
        <source>Search for a kind</source>
        <translation>種別を検索</translation>
    </message>
    <message>
        <source>On the map</source>
        <translation>図面にある種別</translation>
    </message>
    <message>
        <source>All other kinds</source>
        <translation>その他の種別</translation>
    </message>
    <message>
        <source>All kinds</source>
        <translation>すべての種別</translation>
    </message>
    <message>
        <source>Key that chooses this kind</source>
        <translation>この種別を選ぶキー</translation>
    </message>
    <message>
        <source>Whether features of this kind are shown</source>
        <translation>この種別の地物を表示するかどうか</translation>
    </message>
</context>
<context>
    <name>LimitsBox</name>
    <message>
        <source>Table of the program</source>
        <translation>標準の規格値表</translation>
    </message>
    <message>
        <source>Other table…</source>
        <translation>別の規格値表…</translation>
    </message>
    <message>
        <source>Write this table as a file…</source>
        <translation>この規格値表をファイルに書き出す…</translation>
    </message>
    <message>
        <source>The work type whose limits the as-built form has</source>
        <translation>出来形管理の規格値に用いる工種です</translation>
    </message>
    <message>
        <source>Limits from {name}</source>
        <translation>規格値表: {name}</translation>
    </message>
</context>
<context>
    <name>LimitsWiring</name>
    <message>
        <source>Table of limits</source>
        <translation>規格値表</translation>
    </message>
    <message>
        <source>Write the table of limits</source>
        <translation>規格値表の書き出し</translation>
    </message>
</context>
<context>
    <name>MainWindow</name>
    <message>
        <source>Tools</source>
        <translation>ツール</translation>
    </message>
    <message>
        <source>Zuka</source>
        <translation>Zuka（図化）</translation>
    </message>
</context>
<context>
    <name>ManualWindow</name>
    <message>
        <source>Search the manual</source>
        <translation>マニュアルを検索</translation>
    </message>
    <message>
        <source>Back</source>
        <translation>戻る</translation>
    </message>
    <message>
        <source>Forward</source>
        <translation>進む</translation>
    </message>
    <message>
        <source>Contents</source>
        <translation>目次</translation>
    </message>
    <message>
        <source>Open in the browser</source>
        <translation>ブラウザで開く</translation>
    </message>
    <message>
        <source>Nothing found.</source>
        <translation>見つかりません。</translation>
    </message>
</context>
<context>
    <name>MapView</name>
    <message>
        <source>A recording is shown here from above.</source>
        <translation>ここに計測データが真上から表示されます。</translation>
    </message>
    <message>
        <source>Hide what stands high above the road</source>
        <translation>路面より高い点を非表示</translation>
    </message>
    <message>
        <source>Hide nothing</source>
        <translation>非表示にしない</translation>
    </message>
    <message>
        <source>Higher than {metres} m</source>
        <translation>路面から {metres} m を超える点</translation>
    </message>
</context>
<context>
    <name>MessageBar</name>
    <message>
        <source>Close this message</source>
        <translation>このメッセージを閉じる</translation>
    </message>
</context>
<context>
    <name>Minimap</name>
    <message>
        <source>The whole recording; click or drag to go there</source>
        <translation>計測データ全体。クリックまたはドラッグでその位置へ移動します</translation>
    </message>
</context>
<context>
    <name>OccludedRow</name>
    <message>
        <source>Next</source>
        <translation>次へ</translation>
    </message>
    <message>
        <source>Move the cursor to the next vertex without a measured point</source>
        <translation>計測点のない次の頂点へカーソルを移動します</translation>
    </message>
    <message>
        <source>{count} of {total} vertices without a measured point</source>
        <translation>計測点のない頂点: {total}点中{count}点</translation>
    </message>
</context>
<context>
    <name>OcclusionBox</name>
    <message>
        <source>What the model looked at</source>
        <translation>モデルが見たところ</translation>
    </message>
</context>
<context>
    <name>OffsetForm</name>
    <message>
        <source>From points</source>
        <translation>対応点から</translation>
    </message>
    <message>
        <source>Click a thing in the image, then the same thing in another view; repeat.</source>
        <translation>画像で対象をクリックし、別のビューで同じものをクリックします。これを繰り返します。</translation>
    </message>
    <message>
        <source>Drop last pair</source>
        <translation>最後の対応点を削除</translation>
    </message>
    <message>
        <source>Estimate</source>
        <translation>計算</translation>
    </message>
    <message>
        <source>As delivered</source>
        <translation>納品時に戻す</translation>
    </message>
    <message>
        <source>Save</source>
        <translation>保存</translation>
    </message>
    <message>
        <source>Roll</source>
        <translation>ロール</translation>
    </message>
    <message>
        <source>Pitch</source>
        <translation>ピッチ</translation>
    </message>
    <message>
        <source>Yaw</source>
        <translation>ヨー</translation>
    </message>
    <message>
        <source>Right</source>
        <translation>右</translation>
    </message>
    <message>
        <source>Up</source>
        <translation>上</translation>
    </message>
    <message>
        <source>Forward</source>
        <translation>前</translation>
    </message>
    <message>
        <source>Time</source>
        <translation>時刻</translation>
    </message>
    <message>
        <source>Camera “{name}”: added to what was delivered</source>
        <translation>カメラ「{name}」: 納品値に加える補正</translation>
    </message>
    <message>
        <source>Now click the same thing in another view.</source>
        <translation>続けて別のビューで同じものをクリックしてください。</translation>
    </message>
    <message>
        <source>Click a thing in the image.</source>
        <translation>画像で対象をクリックしてください。</translation>
    </message>
    <message numerus="yes">
        <source>%n pair(s), off by {each} px</source>
        <translation>
            <numerusform>対応点 %n 組、残差 {each} px</numerusform>
        </translation>
    </message>
</context>
<context>
    <name>PaneHeader</name>
    <message>
        <source>Close this image</source>
        <translation>この画像を閉じる</translation>
    </message>
</context>
<context>
    <name>ParameterForm</name>
    <message>
        <source>This tool needs no settings.</source>
        <translation>このツールに設定項目はありません。</translation>
    </message>
    <message>
        <source>{low} to {high} {unit}</source>
        <translation>{low} ～ {high} {unit}</translation>
    </message>
</context>
<context>
    <name>ParameterRow</name>
    <message>
        <source>Back to the default</source>
        <translation>既定値に戻す</translation>
    </message>
    <message>
        <source>None</source>
        <translation>なし</translation>
    </message>
    <message>
        <source>Choose a file</source>
        <translation>ファイルを選択</translation>
    </message>
</context>
<context>
    <name>PhotoRow</name>
    <message>
        <source>Picture</source>
        <translation>写真</translation>
    </message>
</context>
<context>
    <name>PlaneView</name>
    <message>
        <source>Show everything</source>
        <translation>全体を表示</translation>
    </message>
    <message>
        <source>Centre on the selection</source>
        <translation>選択した地物を中央に表示</translation>
    </message>
</context>
<context>
    <name>PointMaking</name>
    <message>
        <source>Write the points</source>
        <translation>点群の書き出し</translation>
    </message>
</context>
<context>
    <name>PrintForm</name>
    <message>
        <source>Print</source>
        <translation>印刷</translation>
    </message>
    <message>
        <source>Unchecked candidates as well</source>
        <translation>未確認の候補も含める</translation>
    </message>
    <message>
        <source>Sheets</source>
        <translation>図面</translation>
    </message>
    <message>
        <source>Print…</source>
        <translation>印刷…</translation>
    </message>
</context>
<context>
    <name>ProcessingPanel</name>
    <message>
        <source>Search for a tool</source>
        <translation>ツールを検索</translation>
    </message>
    <message>
        <source>Run</source>
        <translation>実行</translation>
    </message>
    <message>
        <source>Choose another tool</source>
        <translation>別のツールを選ぶ</translation>
    </message>
</context>
<context>
    <name>ProjectCheckForm</name>
    <message>
        <source>Check of {name}</source>
        <translation>{name} の検査</translation>
    </message>
    <message>
        <source>State</source>
        <translation>状態</translation>
    </message>
    <message>
        <source>File</source>
        <translation>ファイル</translation>
    </message>
    <message>
        <source>What is wrong</source>
        <translation>内容</translation>
    </message>
    <message>
        <source>Remedy</source>
        <translation>対処</translation>
    </message>
    <message>
        <source>damaged</source>
        <translation>破損</translation>
    </message>
    <message>
        <source>repaired</source>
        <translation>修復</translation>
    </message>
    <message>
        <source>note</source>
        <translation>注意</translation>
    </message>
    <message>
        <source>Repair</source>
        <translation>修復</translation>
    </message>
    <message numerus="yes">
        <source>%n file(s) damaged.</source>
        <translation>
            <numerusform>%n ファイルが壊れています。</numerusform>
        </translation>
    </message>
    <message>
        <source>“Repair” closes the project for a moment and makes again what the delivered files still give; map and labels stay as they are.</source>
        <translation>「修復」を押すとプロジェクトを一時的に閉じ、納品ファイルから作り直せるものを作り直します。図面とラベルは変わりません。</translation>
    </message>
    <message numerus="yes">
        <source>%n file(s) repaired; nothing is damaged any more.</source>
        <translation>
            <numerusform>%n ファイルを修復しました。破損は残っていません。</numerusform>
        </translation>
    </message>
    <message numerus="yes">
        <source>%n file(s) checked: nothing is damaged.</source>
        <translation>
            <numerusform>%n ファイルを検査しました。破損はありません。</numerusform>
        </translation>
    </message>
</context>
<context>
    <name>ProjectChecking</name>
    <message>
        <source>Check project</source>
        <translation>プロジェクトを検査</translation>
    </message>
</context>
<context>
    <name>ProjectDrives</name>
    <message>
        <source>Show in the image</source>
        <translation>画像に表示</translation>
    </message>
    <message>
        <source>Show beside the image</source>
        <translation>画像の横に並べて表示</translation>
    </message>
    <message>
        <source>Show in 3D, map and section</source>
        <translation>3D・地図・断面に表示</translation>
    </message>
    <message>
        <source>Hide in 3D, map and section</source>
        <translation>3D・地図・断面で非表示</translation>
    </message>
    <message>
        <source>Show only this drive there</source>
        <translation>3D・地図・断面にこの走行データだけを表示</translation>
    </message>
    <message>
        <source>Show all drives there</source>
        <translation>3D・地図・断面にすべての走行データを表示</translation>
    </message>
    <message>
        <source>Find delivered files…</source>
        <translation>納品ファイルの場所を指定…</translation>
    </message>
    <message>
        <source>Replace the trajectory…</source>
        <translation>走行軌跡を差し替え…</translation>
    </message>
    <message>
        <source>Add a trajectory…</source>
        <translation>走行軌跡を追加…</translation>
    </message>
    <message>
        <source>Add camera images…</source>
        <translation>カメラ画像を追加…</translation>
    </message>
    <message>
        <source>Properties…</source>
        <translation>プロパティ…</translation>
    </message>
    <message>
        <source>Remove from the project</source>
        <translation>プロジェクトから除く</translation>
    </message>
</context>
<context>
    <name>ProjectRuns</name>
    <message>
        <source>Review this run</source>
        <translation>この実行の候補を確認</translation>
    </message>
    <message>
        <source>Compare with another run…</source>
        <translation>ほかの実行結果と比較…</translation>
    </message>
    <message>
        <source>Show its features</source>
        <translation>この実行の地物を表示</translation>
    </message>
    <message>
        <source>Hide its features</source>
        <translation>この実行の地物を非表示</translation>
    </message>
    <message>
        <source>Delete its undecided candidates</source>
        <translation>未判定の候補を削除</translation>
    </message>
</context>
<context>
    <name>ProjectTree</name>
    <message>
        <source>Drives appear here once a project is open.</source>
        <translation>プロジェクトを開くと、ここに走行データを表示します。</translation>
    </message>
    <message>
        <source>Drives</source>
        <translation>走行データ</translation>
    </message>
    <message>
        <source>Camera images</source>
        <translation>カメラ画像</translation>
    </message>
    <message numerus="yes">
        <source>{name}: %n image(s)</source>
        <translation>
            <numerusform>{name}: %n 枚</numerusform>
        </translation>
    </message>
    <message>
        <source>Runs</source>
        <translation>処理履歴</translation>
    </message>
</context>
<context>
    <name>QualityPanel</name>
    <message>
        <source>Check the map</source>
        <translation>図面を点検</translation>
    </message>
    <message>
        <source>Mend</source>
        <translation>修正</translation>
    </message>
    <message>
        <source>Deletes copies and slips, joins ends: the rows marked, or all where none is</source>
        <translation>重複と描き損じを削除し、端点を接合します（選択した行。選択がなければすべて）</translation>
    </message>
    <message>
        <source>Rule</source>
        <translation>点検項目</translation>
    </message>
    <message>
        <source>Kind</source>
        <translation>種別</translation>
    </message>
    <message>
        <source>Size</source>
        <translation>大きさ</translation>
    </message>
    <message>
        <source>What to do</source>
        <translation>対処</translation>
    </message>
    <message>
        <source>Nothing is drawn yet.</source>
        <translation>まだ何も描かれていません。</translation>
    </message>
    <message>
        <source>Checking…</source>
        <translation>点検中…</translation>
    </message>
    <message>
        <source>Finds crossings, open ends, copies, overlaps and what is missing.</source>
        <translation>線の交差、端点の不接合、重複、面の重なり、不足を調べます。</translation>
    </message>
    <message>
        <source>Nothing was found.</source>
        <translation>指摘はありません。</translation>
    </message>
    <message>
        <source>{errors} errors, {others} to look at</source>
        <translation>不適合 {errors}件、要確認 {others}件</translation>
    </message>
</context>
<context>
    <name>Quitting</name>
    <message>
        <source>Quit</source>
        <translation>終了</translation>
    </message>
    <message numerus="yes">
        <source>%n job(s) are not finished.</source>
        <translation>
            <numerusform>%n件のジョブが終了していません。</numerusform>
        </translation>
    </message>
    <message>
        <source>Imports can go on the next time; other jobs are given up.</source>
        <translation>インポートは次回に再開できます。その他のジョブは破棄されます。</translation>
    </message>
    <message>
        <source>Wait</source>
        <translation>待つ</translation>
    </message>
    <message>
        <source>Quit now</source>
        <translation>終了する</translation>
    </message>
</context>
<context>
    <name>ReferenceSystemBox</name>
    <message>
        <source>As the files say</source>
        <translation>ファイルの記載に従う</translation>
    </message>
    <message>
        <source>{code}  Plane rectangular system {zone} (JGD2011)</source>
        <translation>{code}  平面直角座標系 第{zone}系（JGD2011）</translation>
    </message>
</context>
<context>
    <name>ReferenceSystemForm</name>
    <message>
        <source>Reference system</source>
        <translation>座標参照系</translation>
    </message>
    <message>
        <source>Give a code such as EPSG:6677.</source>
        <translation>EPSG:6677 のようなコードを指定してください。</translation>
    </message>
</context>
<context>
    <name>ReviewPanel</name>
    <message numerus="yes">
        <source>%n left</source>
        <translation>
            <numerusform>残り%n件</numerusform>
        </translation>
    </message>
    <message>
        <source>Accept</source>
        <translation>採用</translation>
    </message>
    <message>
        <source>Reject</source>
        <translation>却下</translation>
    </message>
    <message>
        <source>Edit</source>
        <translation>修正</translation>
    </message>
    <message>
        <source>Next</source>
        <translation>次へ</translation>
    </message>
    <message>
        <source>Back</source>
        <translation>前へ</translation>
    </message>
    <message>
        <source>The confidence from which all candidates are accepted</source>
        <translation>この信頼度以上の候補をまとめて採用します</translation>
    </message>
    <message>
        <source>Show rejected features</source>
        <translation>却下した地物を表示</translation>
    </message>
    <message>
        <source>End the review</source>
        <translation>確認を終了</translation>
    </message>
    <message>
        <source>All candidates are decided.</source>
        <translation>すべての候補を判定しました。</translation>
    </message>
    <message>
        <source>See how good the runs were</source>
        <translation>実行結果の評価を見る</translation>
    </message>
    <message>
        <source>Candidates that a tool has found are judged here, one key for each.</source>
        <translation>処理ツールが見つけた候補を、キー1つずつで判定します。</translation>
    </message>
    <message>
        <source>Find something with a tool</source>
        <translation>処理ツールで検出する</translation>
    </message>
    <message>
        <source>Start the review</source>
        <translation>確認を開始</translation>
    </message>
    <message>
        <source>Ctrl+Z takes decisions back.</source>
        <translation>Ctrl+Zで判定を取り消せます。</translation>
    </message>
    <message>
        <source>{accepted} accepted · {rejected} rejected</source>
        <translation>採用{accepted} · 却下{rejected}</translation>
    </message>
    <message>
        <source>{count} a minute</source>
        <translation>毎分{count}件</translation>
    </message>
    <message numerus="yes">
        <source>%n candidate(s) wait for a decision.</source>
        <translation>
            <numerusform>判定待ちの候補が%n件あります。</numerusform>
        </translation>
    </message>
    <message numerus="yes">
        <source>Accept line: %n</source>
        <translation>
            <numerusform>一連%n件採用</numerusform>
        </translation>
    </message>
    <message numerus="yes">
        <source>Reject line: %n</source>
        <translation>
            <numerusform>一連%n件却下</numerusform>
        </translation>
    </message>
    <message numerus="yes">
        <source>Accept %n</source>
        <translation>
            <numerusform>%n件を採用</numerusform>
        </translation>
    </message>
</context>
<context>
    <name>RoadPlotView</name>
    <message>
        <source>Road model</source>
        <translation>道路モデル</translation>
    </message>
    <message>
        <source>Previous</source>
        <translation>前へ</translation>
    </message>
    <message>
        <source>Next</source>
        <translation>次へ</translation>
    </message>
</context>
<context>
    <name>RunChooser</name>
    <message>
        <source>The runs whose candidates are judged</source>
        <translation>候補を確認する実行</translation>
    </message>
    <message>
        <source>Worst first</source>
        <translation>信頼度の低い順</translation>
    </message>
    <message>
        <source>Along the street</source>
        <translation>道路沿いの順</translation>
    </message>
    <message>
        <source>Whether the least certain candidates come first, or the nearest on the drive</source>
        <translation>信頼度の低い候補から確認するか、走行順に確認するか</translation>
    </message>
    <message>
        <source>All runs</source>
        <translation>すべての実行</translation>
    </message>
    <message numerus="yes">
        <source>%n run(s)</source>
        <translation>
            <numerusform>実行%n件</numerusform>
        </translation>
    </message>
    <message numerus="yes">
        <source>%n left</source>
        <translation>
            <numerusform>残り%n件</numerusform>
        </translation>
    </message>
</context>
<context>
    <name>ScenePainter</name>
    <message>
        <source>1 px = {metres:.3f} m</source>
        <translation>1 px = {metres:.3f} m</translation>
    </message>
    <message>
        <source>no “{name}” in this drive</source>
        <translation>この走行データに「{name}」なし</translation>
    </message>
</context>
<context>
    <name>SceneView</name>
    <message>
        <source>Drives appear here in three dimensions once they are shown.</source>
        <translation>走行データを開いて表示すると、ここに3Dで表示されます。</translation>
    </message>
    <message>
        <source>The 3D view is starting.</source>
        <translation>3Dビューを起動しています。</translation>
    </message>
    <message>
        <source>Points are being loaded.</source>
        <translation>点を読み込んでいます。</translation>
    </message>
    <message>
        <source>Along the drive</source>
        <translation>走行方向</translation>
    </message>
    <message>
        <source>From above</source>
        <translation>真上から</translation>
    </message>
    <message>
        <source>Show everything</source>
        <translation>全体を表示</translation>
    </message>
    <message>
        <source>Centre on the selection</source>
        <translation>選択位置を中央に表示</translation>
    </message>
    <message>
        <source>Without perspective</source>
        <translation>平行投影（遠近なし）</translation>
    </message>
    <message>
        <source>Shade by depth (eye-dome lighting)</source>
        <translation>奥行きの陰影（Eye-Dome Lighting）</translation>
    </message>
    <message>
        <source>Show only</source>
        <translation>3Dの表示範囲</translation>
    </message>
    <message>
        <source>All points</source>
        <translation>すべての点</translation>
    </message>
    <message>
        <source>Around what is chosen</source>
        <translation>選択した地物の周囲</translation>
    </message>
    <message>
        <source>Within the section</source>
        <translation>断面の範囲</translation>
    </message>
    <message>
        <source>Around the drive</source>
        <translation>走行軌跡の周囲</translation>
    </message>
</context>
<context>
    <name>SectionBar</name>
    <message>
        <source>Across</source>
        <translation>横断</translation>
    </message>
    <message>
        <source>Along</source>
        <translation>縦断</translation>
    </message>
    <message>
        <source>Cut across the line or along it</source>
        <translation>線を横切る断面か、線に沿った断面かを選びます</translation>
    </message>
    <message>
        <source>Trajectory</source>
        <translation>走行軌跡</translation>
    </message>
    <message>
        <source>Drawn line</source>
        <translation>作図した線</translation>
    </message>
    <message>
        <source>The line that the section stands on</source>
        <translation>断面の基準にする線</translation>
    </message>
    <message>
        <source>Thickness of the slab</source>
        <translation>断面の厚さ（幅）</translation>
    </message>
    <message>
        <source>Distance of a step along the line (Q and W; Shift: ten)</source>
        <translation>線に沿って進む間隔（Q・Wキー、Shiftで10倍）</translation>
    </message>
    <message>
        <source>How many times heights are drawn larger</source>
        <translation>高さ方向の拡大倍率</translation>
    </message>
    <message>
        <source>Ground</source>
        <translation>地面</translation>
    </message>
    <message>
        <source>Draw the ground that was found: dashed where it is filled in</source>
        <translation>抽出した地面の線を描きます（補間した区間は破線）</translation>
    </message>
    <message>
        <source>Tests</source>
        <translation>判定</translation>
    </message>
    <message>
        <source>Show the normalised scanline, and why tools take a place on it or not</source>
        <translation>正規化スキャンラインと、各箇所が採用された理由・されなかった理由を表示</translation>
    </message>
    <message>
        <source>Width</source>
        <translation>幅</translation>
    </message>
    <message>
        <source>Step</source>
        <translation>間隔</translation>
    </message>
    <message>
        <source>Heights</source>
        <translation>高さ</translation>
    </message>
    <message>
        <source>Site axis</source>
        <translation>現場の軸線</translation>
    </message>
    <message>
        <source>Live</source>
        <translation>追従</translation>
    </message>
    <message>
        <source>Follow the mouse over lines in any view</source>
        <translation>どのビューでも、マウスの下にある線の位置へ断面を追従させます</translation>
    </message>
    <message>
        <source>Pin</source>
        <translation>固定</translation>
    </message>
    <message>
        <source>Hold the place as two windows, across and along</source>
        <translation>この位置を横断と縦断の2画面に固定します</translation>
    </message>
    <message>
        <source>Template…</source>
        <translation>テンプレート…</translation>
    </message>
    <message>
        <source>Draw a profile once and fit it along the street</source>
        <translation>断面形状を一度描いて、道路に沿って当てはめます</translation>
    </message>
    <message>
        <source>Profile as DXF…</source>
        <translation>断面図をDXFに書き出す…</translation>
    </message>
    <message>
        <source>Write the ground line with heights, and what crosses it</source>
        <translation>地盤線と高さ、横切る地物を書き出します</translation>
    </message>
</context>
<context>
    <name>SectionMenu</name>
    <message>
        <source>Colour by distance from the plane</source>
        <translation>断面からの距離で色分け</translation>
    </message>
    <message>
        <source>Line of the found ground</source>
        <translation>抽出した地面の線</translation>
    </message>
    <message>
        <source>Scanline and tests</source>
        <translation>スキャンラインと判定</translation>
    </message>
    <message>
        <source>Waveforms along their rays</source>
        <translation>照射方向に沿った波形</translation>
    </message>
    <message>
        <source>Heights</source>
        <translation>高さ</translation>
    </message>
</context>
<context>
    <name>SectionPane</name>
    <message>
        <source>The section appears here once a recording is open.</source>
        <translation>走行データを開くと、ここに断面が表示されます。</translation>
    </message>
    <message>
        <source>Points are being looked for.</source>
        <translation>点を検索しています。</translation>
    </message>
    <message>
        <source>Click a place in another view to cut there.</source>
        <translation>ほかのビューで位置をクリックすると、そこの断面が表示されます。</translation>
    </message>
    <message>
        <source>This recording has no trajectory: select a drawn line to cut across it.</source>
        <translation>このデータには走行軌跡がありません。作図した線を選択すると、その線の断面が表示されます。</translation>
    </message>
</context>
<context>
    <name>ShortcutsForm</name>
    <message>
        <source>Keyboard shortcuts</source>
        <translation>キーボードショートカット</translation>
    </message>
    <message>
        <source>Search by name, menu or key</source>
        <translation>名前・メニュー・キーで検索</translation>
    </message>
    <message>
        <source>Name</source>
        <translation>名前</translation>
    </message>
    <message>
        <source>Menu</source>
        <translation>メニュー</translation>
    </message>
    <message>
        <source>Key</source>
        <translation>キー</translation>
    </message>
    <message>
        <source>Use it here</source>
        <translation>このキーを使う</translation>
    </message>
    <message>
        <source>No key</source>
        <translation>キーなし</translation>
    </message>
    <message>
        <source>Reset this one</source>
        <translation>この項目を初期値に戻す</translation>
    </message>
    <message>
        <source>Reset all</source>
        <translation>すべて初期値に戻す</translation>
    </message>
    <message>
        <source>Save the list…</source>
        <translation>一覧を保存…</translation>
    </message>
    <message>
        <source>New key</source>
        <translation>新しいキー</translation>
    </message>
    <message>
        <source>Choose a command, then press its new key.</source>
        <translation>コマンドを選び、新しいキーを押してください。</translation>
    </message>
    <message>
        <source>This is the same in every view and can&apos;t be changed.</source>
        <translation>すべてのビューで共通の操作のため、変更できません。</translation>
    </message>
    <message>
        <source>Press the new key for: {name}</source>
        <translation>「{name}」の新しいキーを押してください。</translation>
    </message>
    <message>
        <source>Save the list</source>
        <translation>一覧を保存</translation>
    </message>
    <message>
        <source>Tables (*.csv)</source>
        <translation>表 (*.csv)</translation>
    </message>
</context>
<context>
    <name>SideBox</name>
    <message>
        <source>Design from LandXML…</source>
        <translation>設計データ（LandXML）…</translation>
    </message>
    <message>
        <source>Level</source>
        <translation>標高</translation>
    </message>
    <message>
        <source>Level {height} m</source>
        <translation>標高 {height} m</translation>
    </message>
    <message>
        <source>{name} ({day})</source>
        <translation>{name}（{day}）</translation>
    </message>
</context>
<context>
    <name>SimulateForm</name>
    <message>
        <source>Simulate a recording</source>
        <translation>模擬計測データの作成</translation>
    </message>
    <message>
        <source>Create</source>
        <translation>作成</translation>
    </message>
    <message>
        <source>About {points} points, {size}, from {time} of recording.</source>
        <translation>約{points}点、{size}、計測時間は約{time}です。</translation>
    </message>
    <message>
        <source>The disk has only {free} left.</source>
        <translation>ディスクの空き容量が{free}しかありません。</translation>
    </message>
    <message>
        <source>Scan lines every {gap} cm at {speed} km/h. What is hidden, and pulses that don&apos;t come back, are not counted.</source>
        <translation>走査線の間隔は{gap} cm（{speed} km/h）。物の陰や、反射が戻らないパルスは考慮していません。</translation>
    </message>
    <message>
        <source>Choose…</source>
        <translation>選択…</translation>
    </message>
    <message>
        <source>Folder</source>
        <translation>フォルダ</translation>
    </message>
    <message>
        <source>{seconds} s</source>
        <translation>{seconds}秒</translation>
    </message>
    <message>
        <source>{minutes} min</source>
        <translation>{minutes}分</translation>
    </message>
    <message>
        <source>Give a folder for the files.</source>
        <translation>ファイルを作成するフォルダを指定してください。</translation>
    </message>
    <message>
        <source>The folder is not empty; give the name of a new one.</source>
        <translation>フォルダが空ではありません。新しいフォルダ名を指定してください。</translation>
    </message>
</context>
<context>
    <name>Simulations</name>
    <message>
        <source>Open</source>
        <translation>開く</translation>
    </message>
</context>
<context>
    <name>SlabForm</name>
    <message>
        <source>To the left</source>
        <translation>左側</translation>
    </message>
    <message>
        <source>To the right</source>
        <translation>右側</translation>
    </message>
    <message>
        <source>Above the road up to</source>
        <translation>路面からの高さ（上限）</translation>
    </message>
    <message>
        <source>Above the road from</source>
        <translation>路面からの高さ（下限）</translation>
    </message>
</context>
<context>
    <name>StartPage</name>
    <message>
        <source>Recent projects</source>
        <translation>最近使ったプロジェクト</translation>
    </message>
    <message>
        <source>Or drop files here: a project folder, or point clouds with their trajectory and list of images.</source>
        <translation>ファイルをここにドロップすることもできます（プロジェクトフォルダ、または点群と軌跡・画像一覧）。</translation>
    </message>
    <message>
        <source>No project was opened yet.</source>
        <translation>まだプロジェクトを開いていません。</translation>
    </message>
    <message>
        <source>Remove from the list</source>
        <translation>一覧から削除</translation>
    </message>
    <message>
        <source>not found</source>
        <translation>見つかりません</translation>
    </message>
    <message>
        <source>Zuka</source>
        <translation>Zuka（図化）</translation>
    </message>
    <message>
        <source>Import a delivery…</source>
        <translation>納品データをインポート…</translation>
    </message>
    <message>
        <source>Open a project…</source>
        <translation>プロジェクトを開く…</translation>
    </message>
    <message>
        <source>Sample street</source>
        <translation>サンプル街路</translation>
    </message>
    <message>
        <source>Simulate a recording…</source>
        <translation>模擬計測データの作成…</translation>
    </message>
</context>
<context>
    <name>StatusLine</name>
    <message>
        <source>Cancel this job</source>
        <translation>このジョブを中止</translation>
    </message>
    <message>
        <source>{title} {percent} %, {left} left</source>
        <translation>{title} {percent} %、残り{left}</translation>
    </message>
    <message>
        <source>{title} {percent} %</source>
        <translation>{title} {percent} %</translation>
    </message>
    <message>
        <source>reference system unknown</source>
        <translation>座標参照系は不明</translation>
    </message>
</context>
<context>
    <name>StudyForm</name>
    <message>
        <source>Around the points of the truth</source>
        <translation>正解のある点の周辺</translation>
    </message>
    <message>
        <source>On the whole drive</source>
        <translation>走行データ全体</translation>
    </message>
    <message>
        <source>Around few points it is quick; some methods look at the whole cloud, though.</source>
        <translation>点が少ないほど短時間で終わります。ただし、点群全体の統計を使う方法では結果が異なることがあります。</translation>
    </message>
    <message>
        <source>Study</source>
        <translation>検討を実行</translation>
    </message>
    <message>
        <source>Tool</source>
        <translation>ツール</translation>
    </message>
    <message>
        <source>from</source>
        <translation>開始</translation>
    </message>
    <message>
        <source>to</source>
        <translation>終了</translation>
    </message>
    <message>
        <source>values</source>
        <translation>個数</translation>
    </message>
    <message>
        <source>Parameter</source>
        <translation>パラメータ</translation>
    </message>
    <message>
        <source>and</source>
        <translation>もう1つ</translation>
    </message>
    <message>
        <source>Where</source>
        <translation>範囲</translation>
    </message>
    <message>
        <source>no other</source>
        <translation>なし</translation>
    </message>
    <message>
        <source>Choose two different parameters.</source>
        <translation>異なる2つのパラメータを選んでください。</translation>
    </message>
    <message>
        <source>Choose fewer values: at most {most} runs.</source>
        <translation>値を減らしてください（最大{most}回）。</translation>
    </message>
    <message>
        <source>{count} runs; otherwise as in Processing: {settings}</source>
        <translation>{count}回実行。ほかの値は「処理」パネルの設定: {settings}</translation>
    </message>
</context>
<context>
    <name>StudyPanel</name>
    <message>
        <source>Use these values</source>
        <translation>この値を使う</translation>
    </message>
    <message>
        <source>Sets them in the tool&apos;s form; click on the plot for others</source>
        <translation>ツールの設定に反映します。グラフをクリックすると別の値を選べます</translation>
    </message>
    <message>
        <source>Export</source>
        <translation>書き出し</translation>
    </message>
    <message>
        <source>Forget this study</source>
        <translation>この検討結果を削除</translation>
    </message>
    <message>
        <source>No study yet</source>
        <translation>検討結果なし</translation>
    </message>
    <message>
        <source>A study shows here how good each setting is.</source>
        <translation>検討を実行すると、設定ごとの精度がここに表示されます。</translation>
    </message>
    <message>
        <source>a part of {drive}</source>
        <translation>{drive}の一部</translation>
    </message>
    <message>
        <source>precision</source>
        <translation>適合率</translation>
    </message>
    <message>
        <source>recall</source>
        <translation>再現率</translation>
    </message>
    <message>
        <source>now</source>
        <translation>現在</translation>
    </message>
    <message>
        <source>best</source>
        <translation>最良</translation>
    </message>
    <message>
        <source>Table (CSV)</source>
        <translation>表（CSV）</translation>
    </message>
    <message>
        <source>Plot (PNG)</source>
        <translation>グラフ（PNG）</translation>
    </message>
    <message>
        <source>Plot (PDF)</source>
        <translation>グラフ（PDF）</translation>
    </message>
</context>
<context>
    <name>TemplateForm</name>
    <message>
        <source>The line that is made at the marked vertex</source>
        <translation>印の付いた頂点に作成する線</translation>
    </message>
    <message>
        <source>Points this near to the shape lie on it</source>
        <translation>形状からこの距離以内の点を一致とみなします</translation>
    </message>
    <message>
        <source>Line here</source>
        <translation>作成する線</translation>
    </message>
    <message>
        <source>Tolerance</source>
        <translation>許容差</translation>
    </message>
    <message>
        <source>No line</source>
        <translation>作成しない</translation>
    </message>
</context>
<context>
    <name>TemplateList</name>
    <message>
        <source>Draw new</source>
        <translation>新しく描く</translation>
    </message>
    <message>
        <source>Draw the wanted profile in the section</source>
        <translation>あるべき断面形状を断面ビューに描きます</translation>
    </message>
    <message>
        <source>Manage</source>
        <translation>管理</translation>
    </message>
    <message>
        <source>Rename</source>
        <translation>名前の変更</translation>
    </message>
    <message>
        <source>Delete</source>
        <translation>削除</translation>
    </message>
    <message>
        <source>Import…</source>
        <translation>読み込み…</translation>
    </message>
    <message>
        <source>Export…</source>
        <translation>書き出し…</translation>
    </message>
    <message>
        <source>Import a template</source>
        <translation>テンプレートの読み込み</translation>
    </message>
    <message>
        <source>Templates (*.json)</source>
        <translation>テンプレート (*.json)</translation>
    </message>
    <message>
        <source>Export the template</source>
        <translation>テンプレートの書き出し</translation>
    </message>
</context>
<context>
    <name>TemplatePanel</name>
    <message>
        <source>Add empty zone</source>
        <translation>空白域を追加</translation>
    </message>
    <message>
        <source>Draw in the section where no point should be</source>
        <translation>点があってはならない範囲を断面ビューに描きます</translation>
    </message>
    <message>
        <source>Remove zones</source>
        <translation>空白域を削除</translation>
    </message>
    <message>
        <source>Fit from here</source>
        <translation>ここから追跡</translation>
    </message>
    <message>
        <source>Follow the template along the street, both ways from the cursor</source>
        <translation>カーソル位置から道路の両方向にテンプレートを追跡します</translation>
    </message>
    <message>
        <source>Template</source>
        <translation>テンプレート</translation>
    </message>
    <message>
        <source>Draw a curb or a gutter once in the section; it is then fitted along the road.</source>
        <translation>縁石や側溝の形状を断面に一度描くと、道路に沿って追跡できます。</translation>
    </message>
    <message>
        <source>Put the cursor on the curb to see how the template lies.</source>
        <translation>カーソルを縁石の上に置くと、テンプレートの合い具合が表示されます。</translation>
    </message>
    <message>
        <source>Score here: {score}</source>
        <translation>この位置のスコア: {score}</translation>
    </message>
</context>
<context>
    <name>TemplatePicture</name>
    <message>
        <source>Click a vertex to say which line is made there</source>
        <translation>頂点をクリックすると、そこに作成する線を選べます</translation>
    </message>
</context>
<context>
    <name>TruthBar</name>
    <message>
        <source>What points really are, as somebody said</source>
        <translation>点の本来のクラス（人が確認した正解）</translation>
    </message>
    <message>
        <source>New truth</source>
        <translation>正解を登録</translation>
    </message>
    <message>
        <source>Forget this truth</source>
        <translation>この正解を削除</translation>
    </message>
    <message>
        <source>Truth</source>
        <translation>正解</translation>
    </message>
    <message>
        <source>None yet</source>
        <translation>未登録</translation>
    </message>
    <message>
        <source>All points as they stand now</source>
        <translation>すべての点を現在のクラスで</translation>
    </message>
    <message>
        <source>You have checked all that was recorded together: every class is right</source>
        <translation>同時に計測したデータをすべて確認済みで、すべてのクラスが正しい場合に使います</translation>
    </message>
    <message>
        <source>You have checked what the 3D view is clipped to</source>
        <translation>3Dビューで切り出した範囲を確認済みの場合に使います</translation>
    </message>
    <message>
        <source>The part shown in 3D as it stands now</source>
        <translation>3Dビューの表示範囲を現在のクラスで</translation>
    </message>
    <message>
        <source>Points painted by hand, no others</source>
        <translation>手動でラベルを付けた点だけ</translation>
    </message>
    <message>
        <source>Labels that a run gave don&apos;t count unless you painted over them</source>
        <translation>処理の実行で付いたラベルは、手動で塗り直した点を除いて対象外です</translation>
    </message>
    <message>
        <source>From a file…</source>
        <translation>ファイルから…</translation>
    </message>
    <message>
        <source>{count} points</source>
        <translation>{count} 点</translation>
    </message>
</context>
<context>
    <name>ViewDocks</name>
    <message>
        <source>Zuka – views</source>
        <translation>Zuka – ビュー</translation>
    </message>
</context>
<context>
    <name>ViewWiring</name>
    <message>
        <source>Write the profile</source>
        <translation>断面図の書き出し</translation>
    </message>
    <message>
        <source>Write the evaluation</source>
        <translation>評価の書き出し</translation>
    </message>
</context>
<context>
    <name>VolumeForm</name>
    <message>
        <source>Use the selected lines</source>
        <translation>選択した線を使う</translation>
    </message>
    <message>
        <source>As break lines of triangles; a single one also as the axis of sections</source>
        <translation>三角網のブレークラインとして使います。1本だけのときは断面の中心線にもなります</translation>
    </message>
    <message>
        <source>Level</source>
        <translation>標高</translation>
    </message>
    <message>
        <source>Find the ground of both</source>
        <translation>両方の地面を抽出</translation>
    </message>
    <message>
        <source>Compute the volume</source>
        <translation>土量を計算</translation>
    </message>
    <message>
        <source>Before</source>
        <translation>前</translation>
    </message>
    <message>
        <source>After</source>
        <translation>後</translation>
    </message>
    <message>
        <source>Within</source>
        <translation>範囲</translation>
    </message>
    <message>
        <source>The ground has not been separated from what stands on it yet.</source>
        <translation>地面がまだ抽出されていません。</translation>
    </message>
    <message>
        <source>Everything</source>
        <translation>すべて</translation>
    </message>
    <message>
        <source>Selected areas</source>
        <translation>選択した面</translation>
    </message>
    <message>
        <source>Area from a file…</source>
        <translation>ファイルの範囲…</translation>
    </message>
</context>
<context>
    <name>VolumePanel</name>
    <message>
        <source>Volumes computed so far</source>
        <translation>これまでの計算結果</translation>
    </message>
    <message>
        <source>Remove this result</source>
        <translation>この結果を削除</translation>
    </message>
    <message>
        <source>Export</source>
        <translation>書き出し</translation>
    </message>
    <message>
        <source>No volume has been computed yet.</source>
        <translation>計算結果はまだありません。</translation>
    </message>
    <message>
        <source>Compare</source>
        <translation>比較</translation>
    </message>
    <message>
        <source>Result</source>
        <translation>結果</translation>
    </message>
    <message>
        <source>Heat map</source>
        <translation>ヒートマップ</translation>
    </message>
    <message>
        <source>{moment}  {before} → {after}</source>
        <translation>{moment}  {before} → {after}</translation>
    </message>
    <message>
        <source>{before} → {after}, computed {moment}</source>
        <translation>{before} → {after}（{moment} 計算）</translation>
    </message>
</context>
<context>
    <name>VolumeStyleForm</name>
    <message>
        <source>Show the heat map</source>
        <translation>ヒートマップを表示</translation>
    </message>
    <message>
        <source>Where the outermost colours begin</source>
        <translation>両端の色になる標高差です</translation>
    </message>
    <message>
        <source>How much of the points shines through</source>
        <translation>点群の透け具合です</translation>
    </message>
    <message>
        <source>None</source>
        <translation>なし</translation>
    </message>
    <message>
        <source>Of the difference</source>
        <translation>標高差</translation>
    </message>
    <message>
        <source>Of the ground before</source>
        <translation>前の地盤</translation>
    </message>
    <message>
        <source>Of the ground after</source>
        <translation>後の地盤</translation>
    </message>
    <message>
        <source>Between contours; every fifth one is thicker</source>
        <translation>等高線の間隔です。5本ごとに太く描きます</translation>
    </message>
    <message>
        <source>Range</source>
        <translation>範囲</translation>
    </message>
    <message>
        <source>Opacity</source>
        <translation>不透明度</translation>
    </message>
    <message>
        <source>Contours</source>
        <translation>等高線</translation>
    </message>
    <message>
        <source>Interval</source>
        <translation>間隔</translation>
    </message>
</context>
<context>
    <name>VolumeTable</name>
    <message>
        <source>Correct and compute again</source>
        <translation>補正して再計算</translation>
    </message>
    <message>
        <source>Shift of the epochs: E {east}, N {north}, H {up} mm</source>
        <translation>時期間のずれ: E {east}、N {north}、H {up} mm</translation>
    </message>
    <message>
        <source>Shift of the epochs: E {east}, N {north}, H {up} mm (corrected)</source>
        <translation>時期間のずれ: E {east}、N {north}、H {up} mm（補正済み）</translation>
    </message>
    <message>
        <source>From {area} m² of unchanged ground, each within {sure} mm</source>
        <translation>変化のない地面 {area} m² から推定（各成分 ±{sure} mm）</translation>
    </message>
    <message>
        <source>Cut</source>
        <translation>切土量</translation>
    </message>
    <message>
        <source>Fill</source>
        <translation>盛土量</translation>
    </message>
    <message>
        <source>Net (fill less cut)</source>
        <translation>差引土量（盛土−切土）</translation>
    </message>
    <message>
        <source>Uncertainty (95 %)</source>
        <translation>不確かさ（95%）</translation>
    </message>
    <message>
        <source>Area</source>
        <translation>面積</translation>
    </message>
    <message>
        <source>Not measured on a date</source>
        <translation>どちらかの時期に未計測の面積</translation>
    </message>
    <message>
        <source>Of it left out</source>
        <translation>うち計算から除外した面積</translation>
    </message>
</context>
<context>
    <name>VolumeWiring</name>
    <message>
        <source>Export the volume</source>
        <translation>土量の書き出し</translation>
    </message>
    <message>
        <source>The area that is computed within</source>
        <translation>計算する範囲</translation>
    </message>
    <message>
        <source>Design surface</source>
        <translation>設計面</translation>
    </message>
</context>
<context>
    <name>WorkDetailsForm</name>
    <message>
        <source>Work details</source>
        <translation>工事情報</translation>
    </message>
    <message>
        <source>What reports and forms say of the work. What is empty is left blank.</source>
        <translation>帳票に記載する工事の情報です。空欄の項目は空白で出力します。</translation>
    </message>
</context>
<context>
    <name>WrittenFilesOffer</name>
    <message>
        <source>Open the folder</source>
        <translation>フォルダを開く</translation>
    </message>
    <message>
        <source>Open a file</source>
        <translation>ファイルを開く</translation>
    </message>
</context>
<context>
    <name>_JobRow</name>
    <message>
        <source>Cancel this job</source>
        <translation>このジョブを中止</translation>
    </message>
    <message>
        <source>{percent}, {left} left</source>
        <translation>{percent}、残り{left}</translation>
    </message>
    <message>
        <source>waiting</source>
        <translation>待機中</translation>
    </message>
    <message>
        <source>done</source>
        <translation>完了</translation>
    </message>
    <message>
        <source>failed</source>
        <translation>失敗</translation>
    </message>
    <message>
        <source>cancelled</source>
        <translation>中止</translation>
    </message>
    <message>
        <source>Began at {time}</source>
        <translation>開始 {time}</translation>
    </message>
</context>
<context>
    <name>parts.window</name>
    <message>
        <source>What to draw</source>
        <translation>作図する種別</translation>
    </message>
</context>
</TS>
